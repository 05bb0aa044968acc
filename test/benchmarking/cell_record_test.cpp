// What a cell's folder says of it, and what it must not be taken for.
#include "evolin_ros/benchmarking/cell_record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

CellRecord sample(CellState state) {
  CellRecord record;
  record.id = "room--lsd--lbd--all";
  record.sequence = "room";
  record.detector = "lsd";
  record.associator = "lbd";
  record.setting = "all";
  record.content_hash = "abc";
  record.program_version = "1";
  record.state = state;
  record.seconds = 2.5;
  return record;
}

TEST(CellRecord, ComesBackAsItWasWritten) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(readCellRecord(folder.path()));
  CellRecord record = sample(CellState::kFailed);
  record.error = "why \xff not";
  writeCellRecord(record, folder.path());
  const std::optional<CellRecord> found = readCellRecord(folder.path());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->id, record.id);
  EXPECT_EQ(found->state, CellState::kFailed);
  EXPECT_EQ(found->error, "why \xef\xbf\xbd not") << "always valid UTF-8";
  EXPECT_EQ(found->seconds, 2.5);
}

TEST(CellRecord, OnlyAReportOfTheSameContentIsFinished) {
  const test::TemporaryFolder folder;
  CellRecord wanted = sample(CellState::kPending);
  EXPECT_EQ(stateOf(wanted, folder.path()).state, CellState::kPending);
  writeCellRecord(sample(CellState::kFinished), folder.path());
  EXPECT_EQ(stateOf(wanted, folder.path()).state, CellState::kPending) << "no report";
  folder.write("report.json", "{}");
  EXPECT_EQ(stateOf(wanted, folder.path()).state, CellState::kFinished);
  wanted.content_hash = "other";
  EXPECT_EQ(stateOf(wanted, folder.path()).state, CellState::kPending);
  wanted.content_hash = "";
  EXPECT_EQ(stateOf(wanted, folder.path()).state, CellState::kPending);
}

TEST(CellRecord, WhatCannotBeReadIsNoRecord) {
  const test::TemporaryFolder folder;
  for (const char* text : {"", "{", "[]", "{}", R"({"id": 3})"}) {
    folder.write("cell.json", text);
    EXPECT_FALSE(readCellRecord(folder.path())) << text;
  }
}

TEST(CellRecord, TheMatrixHasEveryCellInOrderWithLabelsAndReasons) {
  BenchmarkMatrix matrix;
  matrix.sequences.resize(1);
  matrix.sequences[0].name = "room";
  matrix.sequences[0].metrics = {MetricFamily::kDetection, MetricFamily::kAssociation};
  matrix.detectors.resize(1);
  matrix.detectors[0].name = "lsd";
  matrix.detectors[0].label = "LSD";
  matrix.associators.resize(1);
  matrix.associators[0].name = "lbd";
  matrix.associators[0].label = "LBD";
  matrix.settings.resize(2);
  matrix.settings[0] = {"lines", "f:1", {MetricFamily::kDetection}, true, {}, {}, {0}, {0}, {0}};
  matrix.settings[1] = {"truth", "f:2", {MetricFamily::kAssociation}, true, {}, {}, {0}, {0}, {0}};
  expandCells(&matrix);
  ASSERT_EQ(matrix.cells.size(), 2U);
  std::vector<CellRecord> records;
  for (const BenchmarkCell& cell : matrix.cells) {
    records.push_back(recordOf(matrix, cell));
  }
  records[0].state = CellState::kFinished;
  records[0].content_hash = "abc";
  records[1].state = CellState::kUnavailable;
  records[1].error = "no weights";
  const nlohmann::json json = nlohmann::json::parse(matrixJson(matrix, records));
  const nlohmann::json& cells = json.at("cells");
  EXPECT_EQ(cells.at(0).at("id"), "room--lsd--none--lines");
  EXPECT_EQ(cells.at(0).at("detector_label"), "LSD");
  EXPECT_EQ(cells.at(0).at("state"), "finished");
  EXPECT_TRUE(cells.at(0).at("reason").is_null());
  EXPECT_EQ(cells.at(0).at("content_hash"), "abc");
  EXPECT_TRUE(cells.at(1).at("content_hash").is_null());
  EXPECT_EQ(cells.at(1).at("detector"), "none");
  EXPECT_TRUE(cells.at(1).at("detector_label").is_null());
  EXPECT_EQ(cells.at(1).at("associator"), "lbd");
  EXPECT_EQ(cells.at(1).at("reason"), "no weights");
}

}  // namespace
}  // namespace evolin
