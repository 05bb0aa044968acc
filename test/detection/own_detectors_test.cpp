// What every detector of our own owes: hand-made figures, awkward images, independent instances.
#include "test/detection/own_detectors.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "evolin_ros/detection/elsed.h"
#include "evolin_ros/detection/fsg.h"
#include "evolin_ros/detection/lsd.h"
#include "evolin_ros/detection/lswms.h"

namespace evolin {
namespace {

/// Allocations a frame: the result, and what OpenCV's filters and the table for another size take.
template <typename Detector>
constexpr std::size_t kMostAllocations = 20;
template <>
constexpr std::size_t kMostAllocations<Elsed> = 1;
template <>
constexpr std::size_t kMostAllocations<Lswms> = 1;

template <typename Detector>
class OwnDetector : public ::testing::Test {
 protected:
  void SetUp() override { detector_.configure(YAML::Node()); }

  Detector detector_;
};

using Detectors = ::testing::Types<Elsed, Fsg, Lsd, Lswms>;
TYPED_TEST_SUITE(OwnDetector, Detectors, );

TYPED_TEST(OwnDetector, FindsTheSidesOfAQuadrilateral) {
  test::expectFindsQuadrilateral(&this->detector_);
}

TYPED_TEST(OwnDetector, SurvivesAwkwardImages) {
  test::expectSurvivesAwkwardImages(&this->detector_);
}

TYPED_TEST(OwnDetector, RefusesOtherImages) { test::expectRefusesOtherImages(&this->detector_); }

TYPED_TEST(OwnDetector, IsIndependentOfOtherFrames) {
  test::expectIndependentOfOtherFrames<TypeParam>();
}

TYPED_TEST(OwnDetector, ReusesItsMemory) {
  test::expectReusesMemory(&this->detector_, kMostAllocations<TypeParam>);
}

TYPED_TEST(OwnDetector, SelectsByLengthAndNumber) { test::expectSelects<TypeParam>(); }

TYPED_TEST(OwnDetector, RefusesToDetectBeforeItIsConfigured) {
  TypeParam fresh;
  Frame frame;
  frame.image = test::quadrilateralImage();
  EXPECT_THROW(fresh.detect(frame), Error);
}

}  // namespace
}  // namespace evolin
