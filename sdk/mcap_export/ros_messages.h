// The ROS 2 messages of an exported flight, as Humble and later have them (packages common_interfaces,
// geometry2 and rcl_interfaces). Names, order and types of the fields are theirs.
#pragma once
#include "sdk/mcap_export/cdr.h"

namespace karst::ros {
struct Time {
  static constexpr const char* kType = "builtin_interfaces/Time";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"sec", &Time::sec}, Field{"nanosec", &Time::nanosec});
  }
};

struct Duration {
  static constexpr const char* kType = "builtin_interfaces/Duration";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"sec", &Duration::sec}, Field{"nanosec", &Duration::nanosec});
  }
};

struct Header {
  static constexpr const char* kType = "std_msgs/Header";
  Time stamp;
  std::string frame_id;
  static constexpr auto members() {
    return std::make_tuple(Field{"stamp", &Header::stamp}, Field{"frame_id", &Header::frame_id});
  }
};

struct ColorRGBA {
  static constexpr const char* kType = "std_msgs/ColorRGBA";
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"r", &ColorRGBA::r}, Field{"g", &ColorRGBA::g}, Field{"b", &ColorRGBA::b},
                           Field{"a", &ColorRGBA::a});
  }
};

struct Point {
  static constexpr const char* kType = "geometry_msgs/Point";
  double x = 0;
  double y = 0;
  double z = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"x", &Point::x}, Field{"y", &Point::y}, Field{"z", &Point::z});
  }
};

struct Vector3 {
  static constexpr const char* kType = "geometry_msgs/Vector3";
  double x = 0;
  double y = 0;
  double z = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"x", &Vector3::x}, Field{"y", &Vector3::y}, Field{"z", &Vector3::z});
  }
};

struct Quaternion {
  static constexpr const char* kType = "geometry_msgs/Quaternion";
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;
  static constexpr auto members() {
    return std::make_tuple(Field{"x", &Quaternion::x}, Field{"y", &Quaternion::y}, Field{"z", &Quaternion::z},
                           Field{"w", &Quaternion::w});
  }
};

struct Pose {
  static constexpr const char* kType = "geometry_msgs/Pose";
  Point position;
  Quaternion orientation;
  static constexpr auto members() {
    return std::make_tuple(Field{"position", &Pose::position}, Field{"orientation", &Pose::orientation});
  }
};

struct PoseStamped {
  static constexpr const char* kType = "geometry_msgs/PoseStamped";
  Header header;
  Pose pose;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &PoseStamped::header}, Field{"pose", &PoseStamped::pose});
  }
};

struct PoseWithCovariance {
  static constexpr const char* kType = "geometry_msgs/PoseWithCovariance";
  Pose pose;
  std::array<double, 36> covariance{};
  static constexpr auto members() {
    return std::make_tuple(Field{"pose", &PoseWithCovariance::pose},
                           Field{"covariance", &PoseWithCovariance::covariance});
  }
};

struct Twist {
  static constexpr const char* kType = "geometry_msgs/Twist";
  Vector3 linear;
  Vector3 angular;
  static constexpr auto members() {
    return std::make_tuple(Field{"linear", &Twist::linear}, Field{"angular", &Twist::angular});
  }
};

struct TwistWithCovariance {
  static constexpr const char* kType = "geometry_msgs/TwistWithCovariance";
  Twist twist;
  std::array<double, 36> covariance{};
  static constexpr auto members() {
    return std::make_tuple(Field{"twist", &TwistWithCovariance::twist},
                           Field{"covariance", &TwistWithCovariance::covariance});
  }
};

struct Transform {
  static constexpr const char* kType = "geometry_msgs/Transform";
  Vector3 translation;
  Quaternion rotation;
  static constexpr auto members() {
    return std::make_tuple(Field{"translation", &Transform::translation},
                           Field{"rotation", &Transform::rotation});
  }
};

struct TransformStamped {
  static constexpr const char* kType = "geometry_msgs/TransformStamped";
  Header header;
  std::string child_frame_id;
  Transform transform;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &TransformStamped::header},
                           Field{"child_frame_id", &TransformStamped::child_frame_id},
                           Field{"transform", &TransformStamped::transform});
  }
};

struct TFMessage {
  static constexpr const char* kType = "tf2_msgs/TFMessage";
  std::vector<TransformStamped> transforms;
  static constexpr auto members() { return std::make_tuple(Field{"transforms", &TFMessage::transforms}); }
};

struct Odometry {
  static constexpr const char* kType = "nav_msgs/Odometry";
  Header header;
  std::string child_frame_id;
  PoseWithCovariance pose;
  TwistWithCovariance twist;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &Odometry::header},
                           Field{"child_frame_id", &Odometry::child_frame_id}, Field{"pose", &Odometry::pose},
                           Field{"twist", &Odometry::twist});
  }
};

struct Path {
  static constexpr const char* kType = "nav_msgs/Path";
  Header header;
  std::vector<PoseStamped> poses;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &Path::header}, Field{"poses", &Path::poses});
  }
};

struct PointField {
  static constexpr const char* kType = "sensor_msgs/PointField";
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"name", &PointField::name}, Field{"offset", &PointField::offset},
                           Field{"datatype", &PointField::datatype}, Field{"count", &PointField::count});
  }
};

struct PointCloud2 {
  static constexpr const char* kType = "sensor_msgs/PointCloud2";
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::uint8_t> data;
  bool is_dense = false;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &PointCloud2::header}, Field{"height", &PointCloud2::height},
                           Field{"width", &PointCloud2::width}, Field{"fields", &PointCloud2::fields},
                           Field{"is_bigendian", &PointCloud2::is_bigendian},
                           Field{"point_step", &PointCloud2::point_step},
                           Field{"row_step", &PointCloud2::row_step}, Field{"data", &PointCloud2::data},
                           Field{"is_dense", &PointCloud2::is_dense});
  }
};

struct BatteryState {
  static constexpr const char* kType = "sensor_msgs/BatteryState";
  Header header;
  float voltage = 0;
  float temperature = 0;
  float current = 0;
  float charge = 0;
  float capacity = 0;
  float design_capacity = 0;
  float percentage = 0;
  std::uint8_t power_supply_status = 0;
  std::uint8_t power_supply_health = 0;
  std::uint8_t power_supply_technology = 0;
  bool present = false;
  std::vector<float> cell_voltage;
  std::vector<float> cell_temperature;
  std::string location;
  std::string serial_number;
  static constexpr auto members() {
    return std::make_tuple(
        Field{"header", &BatteryState::header}, Field{"voltage", &BatteryState::voltage},
        Field{"temperature", &BatteryState::temperature}, Field{"current", &BatteryState::current},
        Field{"charge", &BatteryState::charge}, Field{"capacity", &BatteryState::capacity},
        Field{"design_capacity", &BatteryState::design_capacity},
        Field{"percentage", &BatteryState::percentage},
        Field{"power_supply_status", &BatteryState::power_supply_status},
        Field{"power_supply_health", &BatteryState::power_supply_health},
        Field{"power_supply_technology", &BatteryState::power_supply_technology},
        Field{"present", &BatteryState::present}, Field{"cell_voltage", &BatteryState::cell_voltage},
        Field{"cell_temperature", &BatteryState::cell_temperature},
        Field{"location", &BatteryState::location}, Field{"serial_number", &BatteryState::serial_number});
  }
};

struct CompressedImage {
  static constexpr const char* kType = "sensor_msgs/CompressedImage";
  Header header;
  std::string format;
  std::vector<std::uint8_t> data;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &CompressedImage::header},
                           Field{"format", &CompressedImage::format}, Field{"data", &CompressedImage::data});
  }
};

struct RegionOfInterest {
  static constexpr const char* kType = "sensor_msgs/RegionOfInterest";
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;
  static constexpr auto members() {
    return std::make_tuple(
        Field{"x_offset", &RegionOfInterest::x_offset}, Field{"y_offset", &RegionOfInterest::y_offset},
        Field{"height", &RegionOfInterest::height}, Field{"width", &RegionOfInterest::width},
        Field{"do_rectify", &RegionOfInterest::do_rectify});
  }
};

struct CameraInfo {
  static constexpr const char* kType = "sensor_msgs/CameraInfo";
  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0;
  std::uint32_t binning_y = 0;
  RegionOfInterest roi;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &CameraInfo::header}, Field{"height", &CameraInfo::height},
                           Field{"width", &CameraInfo::width},
                           Field{"distortion_model", &CameraInfo::distortion_model},
                           Field{"d", &CameraInfo::d}, Field{"k", &CameraInfo::k}, Field{"r", &CameraInfo::r},
                           Field{"p", &CameraInfo::p}, Field{"binning_x", &CameraInfo::binning_x},
                           Field{"binning_y", &CameraInfo::binning_y}, Field{"roi", &CameraInfo::roi});
  }
};

struct Imu {
  static constexpr const char* kType = "sensor_msgs/Imu";
  Header header;
  Quaternion orientation;
  std::array<double, 9> orientation_covariance{};
  Vector3 angular_velocity;
  std::array<double, 9> angular_velocity_covariance{};
  Vector3 linear_acceleration;
  std::array<double, 9> linear_acceleration_covariance{};
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &Imu::header}, Field{"orientation", &Imu::orientation},
                           Field{"orientation_covariance", &Imu::orientation_covariance},
                           Field{"angular_velocity", &Imu::angular_velocity},
                           Field{"angular_velocity_covariance", &Imu::angular_velocity_covariance},
                           Field{"linear_acceleration", &Imu::linear_acceleration},
                           Field{"linear_acceleration_covariance", &Imu::linear_acceleration_covariance});
  }
};

struct MagneticField {
  static constexpr const char* kType = "sensor_msgs/MagneticField";
  Header header;
  Vector3 magnetic_field;  // tesla
  std::array<double, 9> magnetic_field_covariance{};
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &MagneticField::header},
                           Field{"magnetic_field", &MagneticField::magnetic_field},
                           Field{"magnetic_field_covariance", &MagneticField::magnetic_field_covariance});
  }
};

struct FluidPressure {
  static constexpr const char* kType = "sensor_msgs/FluidPressure";
  Header header;
  double fluid_pressure = 0;
  double variance = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"header", &FluidPressure::header},
                           Field{"fluid_pressure", &FluidPressure::fluid_pressure},
                           Field{"variance", &FluidPressure::variance});
  }
};

struct UVCoordinate {
  static constexpr const char* kType = "visualization_msgs/UVCoordinate";
  float u = 0;
  float v = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"u", &UVCoordinate::u}, Field{"v", &UVCoordinate::v});
  }
};

struct MeshFile {
  static constexpr const char* kType = "visualization_msgs/MeshFile";
  std::string filename;
  std::vector<std::uint8_t> data;
  static constexpr auto members() {
    return std::make_tuple(Field{"filename", &MeshFile::filename}, Field{"data", &MeshFile::data});
  }
};

struct Marker {
  static constexpr const char* kType = "visualization_msgs/Marker";
  Header header;
  std::string ns;
  std::int32_t id = 0;
  std::int32_t type = 0;
  std::int32_t action = 0;
  Pose pose;
  Vector3 scale;
  ColorRGBA color;
  Duration lifetime;
  bool frame_locked = false;
  std::vector<Point> points;
  std::vector<ColorRGBA> colors;
  std::string texture_resource;
  CompressedImage texture;
  std::vector<UVCoordinate> uv_coordinates;
  std::string text;
  std::string mesh_resource;
  MeshFile mesh_file;
  bool mesh_use_embedded_materials = false;
  static constexpr auto members() {
    return std::make_tuple(
        Field{"header", &Marker::header}, Field{"ns", &Marker::ns}, Field{"id", &Marker::id},
        Field{"type", &Marker::type}, Field{"action", &Marker::action}, Field{"pose", &Marker::pose},
        Field{"scale", &Marker::scale}, Field{"color", &Marker::color}, Field{"lifetime", &Marker::lifetime},
        Field{"frame_locked", &Marker::frame_locked}, Field{"points", &Marker::points},
        Field{"colors", &Marker::colors}, Field{"texture_resource", &Marker::texture_resource},
        Field{"texture", &Marker::texture}, Field{"uv_coordinates", &Marker::uv_coordinates},
        Field{"text", &Marker::text}, Field{"mesh_resource", &Marker::mesh_resource},
        Field{"mesh_file", &Marker::mesh_file},
        Field{"mesh_use_embedded_materials", &Marker::mesh_use_embedded_materials});
  }
};

struct MarkerArray {
  static constexpr const char* kType = "visualization_msgs/MarkerArray";
  std::vector<Marker> markers;
  static constexpr auto members() { return std::make_tuple(Field{"markers", &MarkerArray::markers}); }
};

struct Log {
  static constexpr const char* kType = "rcl_interfaces/Log";
  Time stamp;
  std::uint8_t level = 0;
  std::string name;
  std::string msg;
  std::string file;
  std::string function;
  std::uint32_t line = 0;
  static constexpr auto members() {
    return std::make_tuple(Field{"stamp", &Log::stamp}, Field{"level", &Log::level},
                           Field{"name", &Log::name}, Field{"msg", &Log::msg}, Field{"file", &Log::file},
                           Field{"function", &Log::function}, Field{"line", &Log::line});
  }
};

}  // namespace karst::ros
