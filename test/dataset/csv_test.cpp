// Claims about CSV files: writing then reading is identity, what is malformed is named with its
// row.
#include "evolin_ros/dataset/csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/support/fuzz.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using Numbers = std::vector<double>;

Numbers coordinates(const LineSegments& lines) {
  Numbers result;
  for (const LineSegment& line : lines) {
    result.insert(result.end(), {line.x1, line.y1, line.x2, line.y2});
  }
  return result;
}

/// The message of the ParseError for a file of this content, without the folder's name.
template <typename Read>
std::string messageFor(const Read& read, const std::string& content) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("0001.csv", content);
  try {
    read(file);
  } catch (const ParseError& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  ADD_FAILURE() << "no ParseError for " << content;
  return "";
}

TEST(ReadLinesCsv, ReadsRowsInOrder) {
  const test::TemporaryFolder folder;
  const LineSegments lines =
      readLinesCsv(folder.write("a.csv", "1,2,3,4\n-0.5, 1e2 ,\t0,639.25\r\n"));
  EXPECT_EQ(coordinates(lines), (Numbers{1, 2, 3, 4, -0.5, 100, 0, 639.25}));
  EXPECT_FALSE(lines[0].hasScore());
  EXPECT_EQ(lines[0].id, kNoId);
}

TEST(ReadLinesCsv, TakesOneRowAsOneLineAndNothingAsNone) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(readLinesCsv(folder.write("a.csv", "1,2,3,4")).size(), 1U);
  EXPECT_TRUE(readLinesCsv(folder.write("b.csv", "")).empty());
  EXPECT_TRUE(readLinesCsv(folder.write("c.csv", "\n \n\r\n")).empty());
  EXPECT_EQ(readLinesCsv(folder.write("d.csv", "1,2,3,4\n\n\n")).size(), 1U);
  EXPECT_EQ(readLinesCsv(folder.write("e.csv",
                                      "\xEF\xBB\xBF"
                                      "1,2,3,4\n"))
                .size(),
            1U);
}

TEST(ReadLinesCsv, NamesRowValueAndExpectation) {
  EXPECT_EQ(messageFor(readLinesCsv, "1,2,3,4\n1,2,3\n"),
            "0001.csv:2: expected 4 column(s) x1,y1,x2,y2, got 3 in '1,2,3'");
  EXPECT_EQ(messageFor(readLinesCsv, "1,2,3,4,5"),
            "0001.csv:1: expected 4 column(s) x1,y1,x2,y2, got 5 in '1,2,3,4,5'");
  EXPECT_EQ(messageFor(readLinesCsv, "1 2 3 4"),
            "0001.csv:1: expected 4 column(s) x1,y1,x2,y2, got 1 in '1 2 3 4'");
  EXPECT_EQ(messageFor(readLinesCsv, "1,2,3,4\n\n1,2,3,4"),
            "0001.csv:2: expected 4 column(s) x1,y1,x2,y2, got a blank row");
  EXPECT_EQ(messageFor(readLinesCsv, "1,2,x,4"),
            "0001.csv:1: expected a finite number as x2, got 'x'");
  EXPECT_EQ(messageFor(readLinesCsv, "1,nan,3,4"),
            "0001.csv:1: expected a finite number as y1, got 'nan'");
  EXPECT_EQ(messageFor(readLinesCsv, "1,2,3,-inf"),
            "0001.csv:1: expected a finite number as y2, got '-inf'");
  EXPECT_EQ(messageFor(readLinesCsv, ",2,3,4"),
            "0001.csv:1: expected a finite number as x1, got ''");
  EXPECT_EQ(messageFor(readLinesCsv, "1,2,3,1e999"),
            "0001.csv:1: expected a finite number as y2, got '1e999'");
  EXPECT_THROW(readLinesCsv("/no/such/file.csv"), ParseError);
}

TEST(ReadScoresCsv, ReadsOneNumberARow) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(readScoresCsv(folder.write("a.csv", "0.5\n-1e-3\n")), (Numbers{0.5, -0.001}));
  EXPECT_TRUE(readScoresCsv(folder.write("b.csv", "")).empty());
  EXPECT_EQ(messageFor(readScoresCsv, "0.5\n1,2\n"),
            "0001.csv:2: expected 1 column(s) score, got 2 in '1,2'");
  EXPECT_EQ(messageFor(readScoresCsv, "nan\n"),
            "0001.csv:1: expected a finite number as score, got 'nan'");
}

TEST(ReadIndexPairsCsv, ReadsWholeNumbersInBothForms) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(readIndexPairsCsv(folder.write("a.csv", "0,3\n3.0,3.000e+00\n9007199254740992,1\n")),
            (IndexPairs{{0, 3}, {3, 3}, {9007199254740992, 1}}));
  EXPECT_TRUE(readIndexPairsCsv(folder.write("b.csv", "")).empty());
  EXPECT_EQ(messageFor(readIndexPairsCsv, "0,3.5"),
            "0001.csv:1: expected a whole number >= 0 as j, got '3.5'");
  EXPECT_EQ(messageFor(readIndexPairsCsv, "-1,3"),
            "0001.csv:1: expected a whole number >= 0 as i, got '-1'");
  for (const std::string bad : {"1", "1,2,3", "a,1", "1,nan", "1,inf", "1e300,1", "1,"}) {
    EXPECT_FALSE(messageFor(readIndexPairsCsv, bad).empty()) << bad;
  }
}

TEST(ReadScoredLinesCsv, JoinsByRowAndNamesTheScoreFileOtherwise) {
  const test::TemporaryFolder folder;
  const auto lines = folder.write("lines/1.csv", "1,2,3,4\n5,6,7,8\n");
  const LineSegments read = readScoredLinesCsv(lines, folder.write("scores/1.csv", "0.25\n0.5\n"));
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].score, 0.25);
  EXPECT_EQ(read[1].score, 0.5);
  EXPECT_EQ(read[1].x1, 5);
  const auto few = folder.write("scores/2.csv", "0.25\n");
  try {
    readScoredLinesCsv(lines, few);
    FAIL() << "took one score for two lines";
  } catch (const ParseError& error) {
    EXPECT_EQ(error.file(), few.string());
    EXPECT_EQ(
        std::string(error.what()),
        few.string() + ": has 1 score(s), expected 2, one for each line of " + lines.string());
  }
}

TEST(WriteCsv, ReadsBackTheSame) {
  const test::TemporaryFolder folder;
  std::mt19937_64 random(2);
  const auto any_finite = [&] {
    double value = 0;
    do {
      const std::uint64_t bits = random();
      std::memcpy(&value, &bits, sizeof(value));
    } while (!std::isfinite(value));
    return value;
  };
  LineSegments lines(500);
  for (LineSegment& line : lines) {
    line = {any_finite(), any_finite(), any_finite(), any_finite(), any_finite()};
  }
  writeLinesCsv(folder.path() / "lines" / "0.csv", lines);
  writeScoresCsv(folder.path() / "scores" / "0.csv", lines);
  const LineSegments read =
      readScoredLinesCsv(folder.path() / "lines" / "0.csv", folder.path() / "scores" / "0.csv");
  EXPECT_EQ(coordinates(read), coordinates(lines));
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(read[i].score, lines[i].score);
}

TEST(WriteCsv, WritesShortRowsAndAnEmptyFileForNoLines) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.csv";
  writeLinesCsv(file, {{0.1, 2, 640, -0.25, 0.75}, {1, 1, 1, 1, 2}});
  std::ifstream stream(file);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(content, "0.1,2,640,-0.25\n1,1,1,1\n");
  writeLinesCsv(file, {});
  EXPECT_EQ(std::filesystem::file_size(file), 0U);
}

TEST(WriteCsv, RefusesWhatWouldNotReadBack) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.csv";
  EXPECT_THROW(writeScoresCsv(file, {{1, 2, 3, 4}}), Error);  // has no score
  EXPECT_THROW(writeLinesCsv(file, {{1, 2, 3, std::nan("")}}), Error);
  EXPECT_THROW(writeLinesCsv(file, {{1, std::numeric_limits<double>::infinity(), 3, 4}}), Error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(ReadNumbers, SeparatesByAnyWhiteSpace) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(readNumbers(folder.write("a.txt", "0.3 0.36\t0.4\r\n\n -1\n")),
            (Numbers{0.3, 0.36, 0.4, -1}));
  EXPECT_EQ(messageFor(readNumbers, "0.3\n0.4 x\n"),
            "0001.csv:2: expected numbers separated by white space, got 'x'");
  EXPECT_EQ(messageFor(readNumbers, "0.3,0.4"),
            "0001.csv:1: expected numbers separated by white space, got '0.3,0.4'");
  EXPECT_EQ(messageFor(readNumbers, "nan"),
            "0001.csv:1: expected numbers separated by white space, got 'nan'");
  EXPECT_EQ(messageFor(readNumbers, " \n"),
            "0001.csv: is empty, expected numbers separated by white space");
}

TEST(ListFiles, SortsByNameAndComparesExtensionsWithoutCase) {
  const test::TemporaryFolder folder;
  for (const char* name : {"0002.csv", "0001.CSV", "b.png", "c.txt", ".0003.tmp.csv", "csv"}) {
    folder.write(name, "");
  }
  std::filesystem::create_directory(folder.path() / "folder.csv");
  const auto names = [&](const std::vector<std::string>& extensions) {
    std::vector<std::string> result;
    for (const auto& file : listFiles(folder.path(), extensions)) {
      EXPECT_EQ(file.parent_path(), folder.path());
      result.push_back(file.filename().string());
    }
    return result;
  };
  EXPECT_EQ(names({".csv"}), (std::vector<std::string>{"0001.CSV", "0002.csv"}));
  EXPECT_EQ(names({".PNG", ".csv"}), (std::vector<std::string>{"0001.CSV", "0002.csv", "b.png"}));
}

TEST(ListFiles, NamesTheFolderThatIsMissingOrEmpty) {
  const test::TemporaryFolder folder;
  const auto message_of = [](const std::filesystem::path& path) -> std::string {
    try {
      listFiles(path, {".csv", ".txt"});
    } catch (const Error& error) {
      return error.what();
    }
    return "no Error";
  };
  EXPECT_EQ(message_of(folder.path()), folder.path().string() + ": has no file .csv or .txt");
  const std::string missing = (folder.path() / "missing").string();
  EXPECT_EQ(message_of(missing), missing + ": is no folder, expected one with files .csv or .txt");
  EXPECT_NE(message_of(folder.write("file", "")), "no Error");
}

TEST(Csv, AnswersAnyBytesWithValuesOrOneError) {
  const test::TemporaryFolder folder;
  const std::string lines = "74.7,48.5,640,52.3\n292.27,111.61,484.3,113\n1e2,-3,0.5,9\n";
  const std::string scores = "0.5\n0.25\n1e-3\n";
  const std::string pairs = "0,0\n1,3.0\n22,1\n";
  test::Fuzzer fuzzer(41);
  test::FuzzCounts line_counts;
  test::FuzzCounts score_counts;
  test::FuzzCounts pair_counts;
  test::FuzzCounts number_counts;
  for (int i = 0; i < 3000; ++i) {
    const bool bytes = i % 5 == 0;
    const auto input = [&](const std::string& valid) {
      return bytes ? fuzzer.randomBytes(200) : fuzzer.damaged(valid);
    };
    std::string content = input(lines);
    const auto file = folder.write("lines.csv", content);
    test::countAnswer(
        [&] {
          for (const LineSegment& line : readLinesCsv(file)) EXPECT_TRUE(line.isFinite());
        },
        content, &line_counts);
    content = input(scores);
    const auto score_file = folder.write("scores.csv", content);
    test::countAnswer(
        [&] {
          for (const double score : readScoresCsv(score_file)) EXPECT_TRUE(std::isfinite(score));
        },
        content, &score_counts);
    test::countAnswer([&] { EXPECT_FALSE(readNumbers(score_file).empty()); }, content,
                      &number_counts);
    content = input(pairs);
    const auto pair_file = folder.write("pairs.csv", content);
    test::countAnswer(
        [&] {
          for (const auto& [first, second] : readIndexPairsCsv(pair_file)) {
            EXPECT_GE(std::min(first, second), 0);
          }
        },
        content, &pair_counts);
  }
  for (const test::FuzzCounts& counts : {line_counts, score_counts, pair_counts, number_counts}) {
    EXPECT_GT(counts.values, 300U);
    EXPECT_GT(counts.errors, 500U);
  }
}

TEST(Csv, TakesAVeryLongLineAsOneError) {
  const std::string commas(5000000, ',');
  EXPECT_LT(messageFor(readLinesCsv, commas).size(), 300U);
  EXPECT_LT(messageFor(readLinesCsv, std::string(5000000, '7')).size(), 300U);
  EXPECT_LT(messageFor(readIndexPairsCsv, "1," + std::string(5000000, '7')).size(), 300U);
}

/// Reads a CSV of the shared data by what its folder says it holds; returns its rows.
std::size_t rowsOf(const std::filesystem::path& file) {
  const std::string folder = file.parent_path().filename().string();
  if (folder == "scores") return readScoresCsv(file).size();
  if (folder.find("associations") != std::string::npos) return readIndexPairsCsv(file).size();
  return readLinesCsv(file).size();
}

TEST(Csv, ReadsEveryFileOfTheBenchmarksLayout) {
  EVOLIN_REQUIRE_SHARED_DATA();
  std::size_t files = 0;
  std::size_t empty = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::sharedFolder() / "data")) {
    const std::filesystem::path& file = entry.path();
    // Descriptors, matches with distances, infinite lines and lists of sizes are other formats.
    const std::string name = file.string();
    if (file.extension() != ".csv" || name.find("/lbd/descriptors/") != std::string::npos ||
        name.find("/lbd/matches/") != std::string::npos ||
        name.find("kht_rho_theta") != std::string::npos || file.stem() == "image_sizes") {
      continue;
    }
    ++files;
    std::ifstream stream(file);
    std::size_t rows = 0;
    for (std::string line; std::getline(stream, line);) rows += line.empty() ? 0 : 1;
    empty += rows == 0 ? 1 : 0;
    EXPECT_EQ(rowsOf(file), rows) << file;
  }
  EXPECT_GT(files, 650U);
  EXPECT_GT(empty, 0U);
}

TEST(Csv, ReadsTheScoredLinesOfTheSample) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const auto scored = test::sharedFolder() / "data/icl_nuim_lr_sample/predictions/scored";
  const auto files = listFiles(scored / "lines", {".csv"});
  ASSERT_EQ(files.size(), 10U);
  for (const auto& file : files) {
    const LineSegments lines = readScoredLinesCsv(file, scored / "scores" / file.filename());
    EXPECT_EQ(lines.size(), 1000U);
    for (const LineSegment& line : lines) EXPECT_TRUE(line.hasScore());
  }
  EXPECT_EQ(readNumbers(scored / "score_thresholds.txt"), (Numbers{0.3, 0.36, 0.4}));
}

}  // namespace
}  // namespace evolin
