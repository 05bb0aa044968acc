// Layers of lines over a darkened image, and a margin of text laid out from top to bottom.
#include "evolin_ros/drawing/evaluation_view.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/drawing/canvas.h"

namespace evolin {

namespace {

// The margin's measures, in image pixels.
constexpr double kText = 8;  // height of capital letters
constexpr double kRow = 15;  // from line to line
constexpr double kGap = 9;   // before a section
constexpr double kIndent = 10;
constexpr double kSwatch = 26;

// Of trails, in image pixels.
constexpr double kTrailWidth = 0.75;
constexpr double kTrailDot = 1.25;

void checkRange(const std::string& name, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw Error("view option " + name + " " + formatDouble(value) + ": expected " +
                formatDouble(low) + " to " + formatDouble(high));
  }
}

bool isJudged(const EvaluatedFrame& frame) { return frame.no_verdicts.empty(); }

struct LegendEntry {
  Pen pen;
  std::string name;
  std::size_t count;
};

Pen penOf(const Colour& colour, const ViewOptions& options, bool dashed = false) {
  return {colour, options.line_width, dashed};
}

std::vector<LegendEntry> legendOf(const EvaluatedFrame& frame, const ViewOptions& options) {
  std::vector<LegendEntry> entries;
  if (isJudged(frame)) {
    const LineVerdicts& verdicts = frame.verdicts;
    entries.push_back({penOf(palette::kTruePositive, options), "true positives",
                       verdicts.count(LineVerdict::kTruePositive)});
    entries.push_back({penOf(palette::kFalsePositive, options), "false positives",
                       verdicts.count(LineVerdict::kFalsePositive)});
    entries.push_back({penOf(palette::kMissed, options, true), "missed", verdicts.misses()});
    entries.push_back(
        {penOf(palette::kPlain, options), "not scored", verdicts.count(LineVerdict::kDropped)});
  } else {
    entries.push_back({penOf(palette::kPlain, options), "detected", frame.lines.size()});
  }
  return entries;
}

constexpr int kVerdictRows = 4;

double marginHeight(const EvaluatedFrame& frame) {
  constexpr int kRows = 1 + kVerdictRows + 2;  // the title, the legend with trails and its sentence
  double height = kGap + kGap + kRow * kRows;
  for (const ViewSection& section : frame.sections) {
    height += kGap + kRow * static_cast<double>(1 + section.rows.size());
  }
  return height + kGap;
}

/// Writes from top to bottom.
class MarginWriter {
 public:
  MarginWriter(const cv::Mat& picture, double scale, double left)
      : canvas_(picture, scale), left_(left + kIndent), right_(left + kViewMargin - kIndent) {}

  void gap() { y_ += kGap; }

  void row(const std::string& text, const Colour& colour) { write(fitted(text), left_, colour); }

  void row(const std::string& name, const std::string& value) {
    canvas_.drawText(value, {right_ - Canvas::textWidth(value, kText), baseline()}, kText,
                     palette::kInk);
    write(name, left_ + kIndent, palette::kInk);
  }

  void legend(const LegendEntry& entry) {
    swatch(entry.pen);
    const std::string value = std::to_string(entry.count);
    canvas_.drawText(value, {right_ - Canvas::textWidth(value, kText), baseline()}, kText,
                     palette::kInk);
    write(entry.name, left_ + kSwatch + kIndent, palette::kInk);
  }

  /// Trails have no one colour.
  void trailLegend(std::size_t count) {
    constexpr int kPieces = 3;
    const double middle = baseline() - kText / 2;
    for (int i = 0; i < kPieces; ++i) {
      LineSegment piece;
      piece.x1 = left_ + i * kSwatch / kPieces;
      piece.x2 = left_ + (i + 1) * kSwatch / kPieces;
      piece.y1 = piece.y2 = middle;
      canvas_.drawLine(piece, {colourOfNumber(i), kTrailWidth});
    }
    canvas_.drawDot({left_ + kSwatch, middle}, 2, colourOfNumber(kPieces - 1));
    const std::string value = std::to_string(count);
    canvas_.drawText(value, {right_ - Canvas::textWidth(value, kText), baseline()}, kText,
                     palette::kInk);
    write("followed by matches", left_ + kSwatch + kIndent, palette::kInk);
  }

 private:
  double baseline() const { return y_ + kRow - (kRow - kText) / 2; }

  void swatch(const Pen& pen) {
    LineSegment line;
    line.x1 = left_;
    line.x2 = left_ + kSwatch;
    line.y1 = line.y2 = baseline() - kText / 2;
    canvas_.drawLine(line, {pen.colour, std::max(2.0, pen.width), pen.dashed});
  }

  std::string fitted(const std::string& text) const {
    std::string result = text;
    for (std::size_t kept = text.size();
         kept > 0 && Canvas::textWidth(result, kText) > right_ - left_; --kept) {
      result = text.substr(0, kept - 1) + "...";
    }
    return result;
  }

  void write(const std::string& text, double x, const Colour& colour) {
    canvas_.drawText(text, {x, baseline()}, kText, colour);
    y_ += kRow;
  }

  Canvas canvas_;
  double left_;
  double right_;
  double y_ = 0;
};

void drawMargin(const EvaluatedFrame& frame, const ViewOptions& options, const cv::Mat& picture) {
  MarginWriter writer(picture, options.scale, frame.image.cols);
  writer.gap();
  writer.row(frame.title, palette::kInk);
  writer.gap();
  const std::vector<LegendEntry> legend = legendOf(frame, options);
  for (const LegendEntry& entry : legend) {
    writer.legend(entry);
  }
  // Always as many rows: a picture that changes its size disturbs whoever shows it.
  for (std::size_t i = legend.size(); i < kVerdictRows; ++i) {
    writer.row("", palette::kInk);
  }
  writer.trailLegend(frame.trails.size());
  writer.row(isJudged(frame) ? frame.judged_by : frame.no_verdicts, palette::kFaintInk);
  for (const ViewSection& section : frame.sections) {
    writer.gap();
    writer.row(section.title, palette::kFaintInk);
    for (const ViewRow& row : section.rows) {
      writer.row(row.name, row.value);
    }
  }
}

void drawVerdicts(const EvaluatedFrame& frame, const ViewOptions& options, Canvas* canvas) {
  const auto draw = [&](LineVerdict verdict, const Colour& colour) {
    for (std::size_t row = 0; row < frame.lines.size(); ++row) {
      if (frame.verdicts.predicted[row] == verdict) {
        canvas->drawLine(frame.lines[row], penOf(colour, options));
      }
    }
  };
  // What was done well comes last and stays visible.
  if (options.misses) {
    for (std::size_t row = 0; row < frame.ground_truth.size(); ++row) {
      if (!frame.verdicts.found[row]) {
        canvas->drawLine(frame.ground_truth[row], penOf(palette::kMissed, options, true));
      }
    }
  }
  if (options.dropped) {
    draw(LineVerdict::kDropped, palette::kPlain);
  }
  if (options.false_positives) {
    draw(LineVerdict::kFalsePositive, palette::kFalsePositive);
  }
  if (options.true_positives) {
    draw(LineVerdict::kTruePositive, palette::kTruePositive);
  }
}

/// Thin and below everything else: they move the eye but hide no verdict.
void drawTrails(const std::vector<LineTrail>& trails, Canvas* canvas) {
  for (const LineTrail& trail : trails) {
    const Colour colour = colourOfNumber(trail.track);
    canvas->drawPath(trail.points, {colour, kTrailWidth});
    canvas->drawDot(trail.points.back(), kTrailDot, colour);
  }
}

void drawLayers(const EvaluatedFrame& frame, const ViewOptions& options, const cv::Mat& picture) {
  Canvas canvas(picture, options.scale);
  if (options.trails) {
    drawTrails(frame.trails, &canvas);
  }
  if (isJudged(frame)) {
    drawVerdicts(frame, options, &canvas);
  } else {
    for (const LineSegment& line : frame.lines) {
      canvas.drawLine(line, penOf(palette::kPlain, options));
    }
  }
}

void checkFrame(const EvaluatedFrame& frame) {
  if (frame.image.empty() || (frame.image.type() != CV_8UC1 && frame.image.type() != CV_8UC3)) {
    throw Error("image of " + std::to_string(frame.image.cols) + " x " +
                std::to_string(frame.image.rows) + " pixels, OpenCV's type " +
                std::to_string(frame.image.type()) +
                ": expected pixels of one or three 8-bit channels");
  }
  if (isJudged(frame) && (frame.verdicts.predicted.size() != frame.lines.size() ||
                          frame.verdicts.found.size() != frame.ground_truth.size())) {
    throw Error("verdicts on " + std::to_string(frame.verdicts.predicted.size()) + " and " +
                std::to_string(frame.verdicts.found.size()) + " lines: expected " +
                std::to_string(frame.lines.size()) + " detected and " +
                std::to_string(frame.ground_truth.size()) + " true ones");
  }
}

}  // namespace

void validate(const ViewOptions& options) {
  checkRange("scale", options.scale, 0.25, 8);
  checkRange("brightness", options.brightness, 0, 1);
  checkRange("line_width", options.line_width, 0.25, 20);
}

cv::Size viewSize(const EvaluatedFrame& frame, const ViewOptions& options) {
  double width = frame.image.cols;
  double height = frame.image.rows;
  if (options.margin) {
    width += kViewMargin;
    height = std::max(height, marginHeight(frame));
  }
  return {cvRound(width * options.scale), cvRound(height * options.scale)};
}

cv::Mat drawEvaluatedFrame(const EvaluatedFrame& frame, const ViewOptions& options) {
  validate(options);
  checkFrame(frame);
  cv::Mat picture(viewSize(frame, options), CV_8UC3, toBgr(palette::kPaper));
  const cv::Size shown(cvRound(frame.image.cols * options.scale),
                       cvRound(frame.image.rows * options.scale));
  cv::Mat area = picture(cv::Rect({0, 0}, shown));
  cv::Mat image;
  frame.image.convertTo(image, -1, options.brightness);
  if (image.channels() == 1) {
    cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  }
  cv::resize(image, area, shown, 0, 0, cv::INTER_LINEAR);
  drawLayers(frame, options, area);
  if (options.margin) {
    drawMargin(frame, options, picture);
  }
  return picture;
}

}  // namespace evolin
