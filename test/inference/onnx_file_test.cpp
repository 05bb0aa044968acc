// What an ONNX file says about itself, and that damage is named and never believed.
#include "evolin_ros/inference/onnx_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "test/inference/onnx_bytes.h"
#include "test/support/expect_error.h"
#include "test/support/fuzz.h"
#include "test/support/models.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

namespace onnx = test::onnx;

class OnnxFileTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& content) const {
    return folder_.write("network.onnx", content);
  }

  OnnxFile read(const std::string& content) const { return readOnnxFile(write(content)); }

  void expectRefused(const std::string& content, const std::string& why) const {
    test::expectError<ParseError>([&] { read(content); }, {"network.onnx", why});
  }

  test::TemporaryFolder folder_;
};

TEST_F(OnnxFileTest, TellsInputsOutputsAndSums) {
  const OnnxFile file = read(onnx::model(onnx::reluGraph(32)));
  ASSERT_EQ(file.inputs.size(), 1U);
  EXPECT_EQ(toText(file.inputs[0]), "'image' [1, 3, 32, 32]");
  ASSERT_EQ(file.outputs.size(), 1U);
  EXPECT_EQ(file.outputs[0].name, "maps");
  EXPECT_TRUE(file.isAsRecorded());
  EXPECT_FALSE(read(onnx::model(onnx::reluGraph(32), false)).isAsRecorded());
}

TEST_F(OnnxFileTest, OpenSidesAndWeightsAmongTheInputs) {
  const std::string graph = onnx::bytes(1, onnx::node("Add", {"image", "one"}, "maps")) +
                            onnx::bytes(5, onnx::weight("one", {1}, {1})) +
                            onnx::bytes(11, onnx::value("image", {-1, 4})) +
                            onnx::bytes(11, onnx::value("one", {1})) +
                            onnx::bytes(12, onnx::value("maps", {-1, 4}));
  const OnnxFile file = read(onnx::model(graph));
  ASSERT_EQ(file.inputs.size(), 1U) << "a weight is no input";
  EXPECT_EQ(toText(file.inputs[0]), "'image' [?, 4]");
}

TEST_F(OnnxFileTest, RefusesWhatDoesNotHangTogether) {
  const std::string input = onnx::bytes(11, onnx::value("image", {4}));
  const std::string output = onnx::bytes(12, onnx::value("maps", {4}));
  expectRefused("", "0 bytes");
  expectRefused("no network at all", "no whole ONNX file");
  expectRefused(onnx::number(1, 4), "no graph");
  expectRefused(onnx::model(input + output), "nothing makes the output 'maps'");
  expectRefused(onnx::model(onnx::bytes(1, onnx::node("Relu", {"other"}, "maps")) + input + output),
                "'other', which nothing before it makes");
  expectRefused(onnx::model(onnx::bytes(1, onnx::node("", {"image"}, "maps")) + input + output),
                "without a type");
  expectRefused(onnx::model(onnx::bytes(1, onnx::node("Relu", {"image"}, "maps")) +
                            onnx::bytes(5, onnx::weight("w", {3}, {1, 2})) + input + output),
                "'w' has 8 bytes instead of 12");
  expectRefused(onnx::model(onnx::bytes(1, onnx::node("Relu", {"image"}, "maps")) +
                            onnx::bytes(5, onnx::number(1, 1ULL << 40U)) + input + output),
                "too large to be true");
  expectRefused(onnx::model(onnx::reluGraph(8)) + onnx::bytes(7, onnx::reluGraph(8)),
                "more than one graph");
}

/// A network beside which there is a weight of these types and fields, with a shape of `elements`.
std::string withWeight(std::uint64_t type, std::uint64_t elements, const std::string& data) {
  return onnx::model(onnx::reluGraph(8) +
                     onnx::bytes(5, onnx::number(1, elements) + onnx::number(2, type) +
                                        onnx::bytes(8, "w") + data));
}

TEST_F(OnnxFileTest, WeightsMayBeListedByTheirType) {
  struct Listed {
    std::uint64_t type;
    unsigned field;
    std::string two;  // elements, packed
    std::string one;  // element by itself
  };
  const std::string large = onnx::varint(1ULL << 40U);
  const std::vector<Listed> all = {
      {1, 4, std::string(8, 'a'), onnx::varint(4U << 3U | 5U) + "abcd"},
      {6, 5, onnx::varint(300) + onnx::varint(1), onnx::number(5, 300)},
      {9, 5, onnx::varint(1) + onnx::varint(0), onnx::number(5, 1)},
      {10, 5, onnx::varint(300) + onnx::varint(1), onnx::number(5, 300)},
      {7, 7, large + onnx::varint(1), onnx::number(7, 1ULL << 40U)},
      {11, 10, std::string(16, 'a'), onnx::varint(10U << 3U | 1U) + "abcdefgh"},
      {12, 11, large + onnx::varint(1), onnx::number(11, 7)},
      {13, 11, large + onnx::varint(1), onnx::number(11, 7)}};
  for (const Listed& one : all) {
    SCOPED_TRACE(one.type);
    const std::string packed = onnx::bytes(one.field, one.two);
    EXPECT_EQ(read(withWeight(one.type, 2, packed)).outputs.size(), 1U);
    EXPECT_EQ(read(withWeight(one.type, 3, packed + one.one)).outputs.size(), 1U);
    expectRefused(withWeight(one.type, 3, packed), "'w' has 2 elements instead of 3");
    expectRefused(withWeight(one.type, 1, packed), "'w' has 2 elements instead of 1");
    expectRefused(withWeight(one.type, 2, ""), "'w' has 0 bytes instead of ");
    expectRefused(withWeight(one.type, 2, packed + onnx::bytes(9, "raw")), "besides its bytes");
    const unsigned foreign = one.field == 7 ? 5 : 7;
    expectRefused(withWeight(one.type, 2, onnx::bytes(foreign, onnx::varint(1) + onnx::varint(2))),
                  "of another type");
    expectRefused(withWeight(one.type, 3, packed + onnx::number(foreign, 1)), "of two types");
  }
  expectRefused(withWeight(1, 2, onnx::bytes(4, "1234567")), "no whole numbers of elements");
  expectRefused(withWeight(7, 1, onnx::varint(7U << 3U | 5U) + "abcd"), "no whole numbers");
}

TEST_F(OnnxFileTest, WeightsAreInTheFileItself) {
  const std::string raw = onnx::bytes(9, std::string(8, 'a'));
  EXPECT_NO_THROW(read(withWeight(1, 2, raw + onnx::number(14, 0)))) << "said outright";
  expectRefused(withWeight(1, 2, raw + onnx::number(14, 1)), "in other files");
  expectRefused(withWeight(1, 2, raw + onnx::bytes(14, "")), "in other files");
  expectRefused(withWeight(1, 2, raw + onnx::bytes(13, onnx::bytes(1, "location"))),
                "in other files");
}

TEST_F(OnnxFileTest, TensorsOfANodeAreWeightsToo) {
  const std::string tensor = onnx::number(1, 2) + onnx::number(2, 7) + onnx::bytes(8, "t");
  for (const unsigned field : {5U, 10U}) {
    const std::string node =
        onnx::node("Abs", {"image"}, "maps") +
        onnx::bytes(5, onnx::bytes(field, tensor + onnx::bytes(7, onnx::varint(1))));
    expectRefused(onnx::model(onnx::bytes(1, node) + onnx::bytes(11, onnx::value("image", {4})) +
                              onnx::bytes(12, onnx::value("maps", {4}))),
                  "'t' has 1 elements instead of 2");
  }
}

TEST_F(OnnxFileTest, RefusesFoldersAndMissingFiles) {
  test::expectError<ParseError>([&] { readOnnxFile(folder_.path()); }, {folder_.path().string()});
  test::expectError<ParseError>([&] { readOnnxFile(folder_.path() / "none.onnx"); },
                                {"none.onnx", "cannot be read"});
}

TEST_F(OnnxFileTest, EveryShorterFileIsRefusedOrLacksItsSum) {
  const std::string whole = onnx::model(onnx::reluGraph(32));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    try {
      EXPECT_FALSE(read(whole.substr(0, size)).isAsRecorded()) << size;
    } catch (const ParseError& error) {
      EXPECT_NE(std::string(error.what()).find("network.onnx"), std::string::npos);
    }
  }
}

TEST_F(OnnxFileTest, DamageIsAnErrorOrShowsInTheSums) {
  const std::string whole = onnx::model(onnx::reluGraph(32));
  const OnnxFile sound = read(whole);
  test::Fuzzer fuzzer(20261123);
  test::FuzzCounts counts;
  for (int round = 0; round < 3000; ++round) {
    const std::string damaged = fuzzer.damaged(whole);
    test::countAnswer(
        [&] {
          const OnnxFile file = read(damaged);
          if (file.isAsRecorded()) {
            EXPECT_EQ(file.graph_digest, sound.graph_digest) << "only what is around may differ";
          }
        },
        damaged, &counts);
  }
  EXPECT_GT(counts.errors, 1000U);
  EXPECT_GT(counts.values, 10U);
}

TEST_F(OnnxFileTest, APublishedFileIsReadAndDamageToItIsFound) {
  const test::Model model = test::sharedModel("lsdnet.onnx");
  EVOLIN_REQUIRE_MODEL(model);
  const OnnxFile sound = readOnnxFile(model.file);
  EXPECT_EQ(sound.digest, "175f2f84430f5c1b22b253afb15526abea80a83284e78edf50deac5a9bd80dc3");
  ASSERT_EQ(sound.inputs.size(), 1U);
  EXPECT_EQ(toText(sound.inputs[0]), "'input_1:0' [?, 288, 288, 3]");
  const std::string whole(sound.bytes.begin(), sound.bytes.end());
  test::Fuzzer fuzzer(5);
  test::FuzzCounts counts;
  for (int round = 0; round < 40; ++round) {
    const std::string damaged = fuzzer.damaged(whole);
    test::countAnswer([&] { EXPECT_NE(read(damaged).digest, sound.digest); }, "", &counts);
  }
  EXPECT_EQ(counts.errors + counts.values, 40U);
}

}  // namespace
}  // namespace evolin
