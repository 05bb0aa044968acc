// The options by which a verb takes a recording, a bag or a dataset folder, and how it is opened.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bag_parts.h"
#include "evolin_ros/dataset/needs.h"
#include "evolin_ros/evaluation/part_reader.h"

namespace evolin::cli {

class RecordingInput {
 public:
  /// Options bound to this object, which outlives the parsing.
  boost::program_options::options_description describe();

  /// Checks values and which options go with which input; throws UsageError.
  void check(const boost::program_options::variables_map& given);

  /// `needs` of the plug-ins that get the frames. Throws UnavailableError for what the recording
  /// does not have for them, else as openFolderParts() and openBagParts().
  std::unique_ptr<PartReader> open(const WantedParts& wanted, const Needs& needs) const;

  /// What else was given of these options, by long name. Paths are absolute, the value of a switch
  /// is empty. Throws Error for a camera that is neither a preset nor a file.
  std::map<std::string, std::string> options() const;

  /// "a.bag, b.bag".
  std::string names() const;

  /// SHA-256 of each bag by its name, as JSON; an empty object for a folder.
  std::string hashes() const;

 private:
  bool isFolder() const;
  std::unique_ptr<PartReader> openComplete(const WantedParts& wanted, const Needs& needs) const;
  void keepGiven(const boost::program_options::variables_map& given);

  std::vector<std::string> inputs_;
  std::map<std::string, std::string> given_;  ///< as it was given
  std::string layout_ = "auto";
  std::string camera_;
  std::string ground_truth_;
  std::string stamps_;
  double duration_ = 0;
  int pose_offset_ = 0;
  SequenceOptions folder_;
  BagPartsOptions bag_;
};

}  // namespace evolin::cli
