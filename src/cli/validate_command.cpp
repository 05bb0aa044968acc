// `evolin validate`.
#include "validate_command.h"

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <iostream>
#include <optional>

#include "evolin_ros/evaluation/agreement_check.h"
#include "evolin_ros/evaluation/recording_check.h"
#include "interrupt.h"
#include "options.h"
#include "progress.h"
#include "recording_input.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Reads a bag or dataset folder as 'evolin run' does and says what is there and what is missing "
    "for which metric: rates, gaps, image sizes, intrinsics, depth, poses, ground truth, and "
    "whether images, depth and poses fit each other or would do so read in another way; each "
    "finding with what to do. Exit status 1 when no metric of lines could be measured.\n\n"
    "Usage: evolin validate BAG|DIR [OPTIONS]";

int runValidate(const std::vector<std::string>& arguments) {
  RecordingInput input;
  bool quiet = false;
  po::options_description description = input.describe();
  description.add_options()("quiet,q", po::bool_switch(&quiet), "no progress");
  po::variables_map given;
  if (!parseOptions(kUsage, description, arguments, &given, "input")) {
    return kExitDone;
  }
  input.check(given);
  const std::unique_ptr<PartReader> reader = input.open({true, true}, {});
  const InterruptGuard guard;
  std::optional<Progress> progress;
  if (!quiet) {
    progress.emplace("images", reader->images());
  }
  RecordingCheck check;
  AgreementCheck agreement(reader->images());
  while (const std::optional<StreamPart> part = reader->next()) {
    check.add(*part);
    agreement.add(*part);
    if (guard.interrupted()) {
      throw Interrupted("interrupted after " + std::to_string(check.images()) +
                        " images; nothing was found out of the rest");
    }
    if (progress) {
      progress->update(check.images());
    }
  }
  if (progress) {
    progress->finish(check.images());
  }
  std::cout << input.names() << "\n" << reader->provenance() << "\n\n";
  std::vector<Finding> findings = check.findings();
  const std::vector<Finding> of_agreement = agreement.findings();
  findings.insert(findings.end(), of_agreement.begin(), of_agreement.end());
  for (const Finding& finding : findings) {
    std::cout << toString(finding.level) << ": " << finding.subject << ": " << finding.text
              << (finding.advice.empty() ? "" : "; " + finding.advice) << "\n";
  }
  for (const std::string& note : reader->notes()) {
    std::cout << toString(Finding::Level::kDoubt) << ": recording: " << note << "\n";
  }
  std::cout << "\n";
  bool any = false;
  for (const FamilyReadiness& family : check.readiness()) {
    any = any || (family.lacks.empty() && family.family != MetricFamily::kTracks);
    std::cout << toString(family.family) << ": "
              << (family.lacks.empty() ? "can be measured" : "lacks " + family.lacks) << "\n";
  }
  return any ? kExitDone : kExitFailed;
}

}  // namespace

Command validateCommand() {
  return {"validate", "what a bag or folder has and lacks, metric by metric", runValidate};
}

}  // namespace evolin::cli
