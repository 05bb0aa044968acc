// A dataset folder's frames taken apart.
#include <deque>
#include <nlohmann/json.hpp>
#include <utility>

#include "evolin_ros/base/text.h"
#include "evolin_ros/evaluation/part_reader.h"

namespace evolin {

namespace {

class FolderParts : public PartReader {
 public:
  FolderParts(std::filesystem::path folder, std::unique_ptr<SequenceReader> reader,
              const WantedParts& wanted)
      : folder_(std::move(folder)), reader_(std::move(reader)), wanted_(wanted) {}

  std::optional<StreamPart> next() override {
    if (parts_.empty()) {
      std::optional<SequenceFrame> frame = reader_->next();
      if (!frame) {
        return std::nullopt;
      }
      takeApart(std::move(*frame));
    }
    StreamPart part = std::move(parts_.front());
    parts_.pop_front();
    return part;
  }

  std::size_t images() const override { return reader_->size(); }
  Needs offers() const override { return reader_->offers(); }

  std::vector<std::string> notes() const override {
    const SequenceCounts& counts = reader_->counts();
    std::vector<std::string> notes;
    const auto tell = [&](std::size_t count, const std::string& text) {
      if (count > 0) {
        notes.push_back(folder_.string() + ": " + std::to_string(count) + " " + text);
      }
    };
    tell(counts.missing_images, "listed images are missing or unreadable, and left out");
    tell(wanted_.motion ? counts.missing_depths : 0, "frames have no depth");
    tell(wanted_.motion ? counts.missing_poses : 0, "frames have no pose");
    tell(wanted_.ground_truth ? counts.missing_ground_truth : 0,
         "frames have no ground-truth lines");
    return notes;
  }

  std::string provenance() const override {
    return nlohmann::ordered_json{{"folder", std::filesystem::absolute(folder_).string()},
                                  {"layout", toString(reader_->layout())},
                                  {"poses", reader_->poseRule()}}
        .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }

 private:
  /// What belongs to an image goes before it, so that it is scored as soon as its lines are there.
  void takeApart(SequenceFrame sequence_frame) {
    Frame& frame = sequence_frame.frame;
    if (wanted_.motion) {
      if (frame.camera) {
        parts_.emplace_back(*frame.camera);
      }
      if (frame.pose) {
        parts_.emplace_back(StampedPose{frame.stamp, *frame.pose});
      }
      if (!frame.depth.empty()) {
        parts_.emplace_back(DepthPart{frame.stamp, DepthMap(frame.depth)});
      }
    }
    if (wanted_.ground_truth && sequence_frame.ground_truth) {
      LineSet truth;
      truth.stamp = frame.stamp;
      truth.source = "ground_truth";
      truth.width = frame.image.cols;
      truth.height = frame.image.rows;
      truth.lines = std::move(*sequence_frame.ground_truth);
      parts_.emplace_back(std::move(truth));
    }
    parts_.emplace_back(ImagePart{std::move(frame), ""});
  }

  std::filesystem::path folder_;
  std::unique_ptr<SequenceReader> reader_;
  WantedParts wanted_;
  std::deque<StreamPart> parts_;
};

}  // namespace

std::unique_ptr<PartReader> openFolderParts(const std::filesystem::path& folder,
                                            const SequenceOptions& options,
                                            const WantedParts& wanted) {
  return std::make_unique<FolderParts>(folder, openSequence(folder, options), wanted);
}

}  // namespace evolin
