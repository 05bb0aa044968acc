// The benchmark's CSV files: lines, scores and index pairs, one file a frame or a pair of frames.
#pragma once

#include <filesystem>
#include <vector>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Rows x1,y1,x2,y2 in pixels. A one-row file is one line, an empty file is no lines; blank rows at
/// the end are ignored. Throws ParseError with the row for a wrong number of columns, text, or a
/// value that is not finite.
LineSegments readLinesCsv(const std::filesystem::path& file);

/// One score a row; errors as above.
std::vector<double> readScoresCsv(const std::filesystem::path& file);

/// Rows i,j of whole numbers >= 0 (also written as 3.0 or 3.000e+00); errors as above.
IndexPairs readIndexPairsCsv(const std::filesystem::path& file);

/// Lines with the scores of the row of the same number; throws ParseError naming the score file
/// when the counts differ.
LineSegments readScoredLinesCsv(const std::filesystem::path& lines,
                                const std::filesystem::path& scores);

void writeLinesCsv(const std::filesystem::path& file, const LineSegments& lines);
void writeScoresCsv(const std::filesystem::path& file, const LineSegments& lines);

/// Numbers separated by white space or line ends, as in score_thresholds.txt; throws ParseError for
/// text, NaN or an empty file.
std::vector<double> readNumbers(const std::filesystem::path& file);

/// Files of `folder` with one of `extensions` (".csv"; compared without case), sorted by name;
/// throws Error naming the folder when it is missing, and when there is none such file.
std::vector<std::filesystem::path> listFiles(const std::filesystem::path& folder,
                                             const std::vector<std::string>& extensions);

}  // namespace evolin
