# Finds out what the installed OpenCV offers to the detectors and associators. Include it after
# find_package(OpenCV). Sets EVOLIN_OPENCV_LIBRARIES (what a target that detects lines links),
# EVOLIN_OPENCV_LINE_DESCRIPTOR (what one that describes them links besides) and EVOLIN_OPENCV_DNN
# (what runs networks; both empty where the module is absent), and writes
# generated/evolin_opencv_features.h, which only src/detection, src/association and src/inference
# include. Nothing here fails when a method is absent: the plug-in says so at run
# time.

include(CMakePushCheckState)
include(CheckCXXSourceCompiles)
include(CheckCXXSourceRuns)

# The modules are imported targets in every OpenCV since 3.0, whichever components were asked for.
set(EVOLIN_OPENCV_LIBRARIES opencv_core opencv_imgproc)
if(TARGET opencv_ximgproc)
  list(APPEND EVOLIN_OPENCV_LIBRARIES opencv_ximgproc)
endif()

# Answers are cached under the version's name, so another OpenCV is asked anew.
string(MAKE_C_IDENTIFIER "${OpenCV_VERSION}" _evolin_opencv)
set(_evolin_fld EVOLIN_OPENCV_${_evolin_opencv}_FAST_LINE_DETECTOR)
set(_evolin_edges EVOLIN_OPENCV_${_evolin_opencv}_EDGE_DRAWING)
set(_evolin_lsd EVOLIN_OPENCV_${_evolin_opencv}_LSD)
set(_evolin_dnn EVOLIN_OPENCV_${_evolin_opencv}_DNN)
set(_evolin_line_descriptor EVOLIN_OPENCV_${_evolin_opencv}_LINE_DESCRIPTOR)

cmake_push_check_state(RESET)
set(CMAKE_REQUIRED_INCLUDES ${OpenCV_INCLUDE_DIRS})
set(CMAKE_REQUIRED_LIBRARIES ${EVOLIN_OPENCV_LIBRARIES})
set(CMAKE_REQUIRED_FLAGS "-std=c++17")
set(CMAKE_REQUIRED_QUIET ON)

if(TARGET opencv_ximgproc)
  check_cxx_source_compiles("
    #include <opencv2/ximgproc.hpp>
    int main() {
      return cv::ximgproc::createFastLineDetector(10, 1.4f, 50, 50, 3, false).empty() ? 1 : 0;
    }" ${_evolin_fld})
  check_cxx_source_compiles("
    #include <opencv2/ximgproc/edge_drawing.hpp>
    int main() {
      cv::ximgproc::EdgeDrawing::Params params;
      params.PFmode = params.SumFlag = params.NFAValidation = false;
      params.EdgeDetectionOperator = cv::ximgproc::EdgeDrawing::PREWITT;
      params.GradientThresholdValue = params.AnchorThresholdValue = params.ScanInterval = 1;
      params.MinPathLength = params.MinLineLength = 10;
      params.Sigma = 1;
      params.MaxDistanceBetweenTwoLines = params.LineFitErrorThreshold = 1;
      params.MaxErrorThreshold = 1;
      cv::Ptr<cv::ximgproc::EdgeDrawing> edges = cv::ximgproc::createEdgeDrawing();
      edges->setParams(params);
      return 0;
    }" ${_evolin_edges})
endif()

# LSD's header was there even in the versions whose constructor only throws, so it has to be run.
if(CMAKE_CROSSCOMPILING)
  if(OpenCV_VERSION VERSION_GREATER_EQUAL 4.5.4
      OR (OpenCV_VERSION VERSION_GREATER_EQUAL 3.4.16 AND OpenCV_VERSION VERSION_LESS 4.0)
      OR (OpenCV_VERSION VERSION_GREATER_EQUAL 3.0 AND OpenCV_VERSION VERSION_LESS 3.4.6)
      OR (OpenCV_VERSION VERSION_GREATER_EQUAL 4.0 AND OpenCV_VERSION VERSION_LESS 4.1.0))
    set(${_evolin_lsd} TRUE)
  else()
    set(${_evolin_lsd} FALSE)
  endif()
else()
  check_cxx_source_runs("
    #include <opencv2/imgproc.hpp>
    #include <vector>
    int main() {
      try {
        cv::Mat image(64, 64, CV_8UC1, cv::Scalar(0));
        image.colRange(20, 40).setTo(255);
        std::vector<cv::Vec4f> lines;
        cv::createLineSegmentDetector(cv::LSD_REFINE_ADV)->detect(image, lines);
        return lines.empty() ? 1 : 0;
      } catch (...) {
        return 1;
      }
    }" ${_evolin_lsd})
endif()

if(TARGET opencv_dnn)
  set(CMAKE_REQUIRED_LIBRARIES opencv_core opencv_dnn)
  check_cxx_source_compiles("
    #include <opencv2/dnn.hpp>
    #include <vector>
    int main() {
      cv::dnn::Net net = cv::dnn::readNetFromONNX(std::vector<unsigned char>(1));
      return cv::dnn::getAvailableTargets(cv::dnn::DNN_BACKEND_OPENCV).empty() || net.empty();
    }" ${_evolin_dnn})
endif()

if(TARGET opencv_line_descriptor)
  set(CMAKE_REQUIRED_LIBRARIES opencv_core opencv_line_descriptor)
  check_cxx_source_compiles("
    #include <opencv2/core.hpp>
    #include <opencv2/line_descriptor.hpp>
    #include <vector>
    int main() {
      std::vector<cv::line_descriptor::KeyLine> lines(1);
      lines[0].numOfPixels = 1;
      cv::Mat descriptors;
      cv::line_descriptor::BinaryDescriptor().compute(cv::Mat(), lines, descriptors, false);
      return 0;
    }" ${_evolin_line_descriptor})
endif()
cmake_pop_check_state()

set(EVOLIN_OPENCV_LINE_DESCRIPTOR)
if(${_evolin_line_descriptor})
  set(EVOLIN_OPENCV_LINE_DESCRIPTOR opencv_line_descriptor)
endif()

set(EVOLIN_OPENCV_DNN)
if(${_evolin_dnn})
  set(EVOLIN_OPENCV_DNN opencv_dnn)
endif()

foreach(_evolin_feature LSD FAST_LINE_DETECTOR EDGE_DRAWING LINE_DESCRIPTOR DNN)
  if(EVOLIN_OPENCV_${_evolin_opencv}_${_evolin_feature})
    set(EVOLIN_HAS_${_evolin_feature} 1)
  else()
    set(EVOLIN_HAS_${_evolin_feature} 0)
  endif()
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/evolin_opencv_features.h.in
  ${CMAKE_CURRENT_BINARY_DIR}/generated/evolin_opencv_features.h @ONLY)
message(STATUS "OpenCV ${OpenCV_VERSION}: LSD ${EVOLIN_HAS_LSD}, FastLineDetector "
  "${EVOLIN_HAS_FAST_LINE_DETECTOR}, EdgeDrawing ${EVOLIN_HAS_EDGE_DRAWING}, "
  "BinaryDescriptor ${EVOLIN_HAS_LINE_DESCRIPTOR}, DNN ${EVOLIN_HAS_DNN}")
