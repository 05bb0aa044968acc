// Makes the detectors known to pluginlib; plugins/detectors.xml names the same classes.
#include <pluginlib/class_list_macros.hpp>

#include "evolin_ros/detection/cannylines.h"
#include "evolin_ros/detection/edlines.h"
#include "evolin_ros/detection/elsed.h"
#include "evolin_ros/detection/fld.h"
#include "evolin_ros/detection/fsg.h"
#include "evolin_ros/detection/hough_p.h"
#include "evolin_ros/detection/kht.h"
#include "evolin_ros/detection/lsd.h"
#include "evolin_ros/detection/lsdnet.h"
#include "evolin_ros/detection/lswms.h"
#include "evolin_ros/detection/mlsd.h"
#include "evolin_ros/detection/opencv_edlines.h"
#include "evolin_ros/detection/opencv_fld.h"
#include "evolin_ros/detection/opencv_lsd.h"
#include "evolin_ros/detection/recorded_detector.h"

PLUGINLIB_EXPORT_CLASS(evolin::CannyLines, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::EdLines, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::Elsed, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::Fld, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::Fsg, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::Kht, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::Lsd, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::LsdNet, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::Lswms, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::Mlsd, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::OpenCvLsd, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::OpenCvEdLines, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::OpenCvFld, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::HoughP, evolin::LineDetector)
PLUGINLIB_EXPORT_CLASS(evolin::RecordedDetector, evolin::LineDetector)
