// Makes the associators known to pluginlib; plugins/associators.xml names the same classes.
#include <pluginlib/class_list_macros.hpp>

#include "evolin_ros/association/geometric_associator.h"
#include "evolin_ros/association/lbd_associator.h"
#include "evolin_ros/association/lbd_binary_associator.h"
#include "evolin_ros/association/lk_tracking_associator.h"
#include "evolin_ros/association/oracle_associator.h"
#include "evolin_ros/association/random_associator.h"
#include "evolin_ros/association/recorded_associator.h"

PLUGINLIB_EXPORT_CLASS(evolin::GeometricAssociator, evolin::LineAssociator)
PLUGINLIB_EXPORT_CLASS(evolin::LbdAssociator, evolin::LineAssociator)
PLUGINLIB_EXPORT_CLASS(evolin::LbdBinaryAssociator, evolin::LineAssociator)
PLUGINLIB_EXPORT_CLASS(evolin::LkTrackingAssociator, evolin::LineAssociator)
PLUGINLIB_EXPORT_CLASS(evolin::OpenCvLbdBinaryAssociator, evolin::LineAssociator)
PLUGINLIB_EXPORT_CLASS(evolin::OracleAssociator, evolin::LineAssociator)
PLUGINLIB_EXPORT_CLASS(evolin::RandomAssociator, evolin::LineAssociator)
PLUGINLIB_EXPORT_CLASS(evolin::RecordedAssociator, evolin::LineAssociator)
