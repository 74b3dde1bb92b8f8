// docs/vehicle_protocol.json against the encoder, and against the page.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/unit/socket/any_message.h"

namespace karst::socket {
namespace {

using nlohmann::json;
using testing::bytes_of;
using testing::for_each_type;
using testing::frame_of;

std::string text_of(const std::string& file) {
  std::ifstream in(std::string(KARST_SOURCE_DIR) + "/docs/" + file);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}
const json& schema() {
  static const json parsed = json::parse(text_of("vehicle_protocol.json"));
  return parsed;
}
const json* message_of(std::uint16_t id) {
  for (const json& m : schema()["messages"])
    if (m["id"] == id) return &m;
  return nullptr;
}

/// Reads a body by the schema alone; every number in it becomes a word of `values`.
class SchemaReader {
 public:
  explicit SchemaReader(std::string_view body) : body_(body) {}
  void read(const json& fields) {
    for (const json& field : fields) read_type(field["type"]);
  }
  bool at_end() const { return at_ == body_.size() && !short_; }
  const std::vector<std::string>& values() const { return values_; }

 private:
  template <class T>
  T take() {
    T value{};
    if (at_ + sizeof value > body_.size()) {
      short_ = true;
      return value;
    }
    std::memcpy(&value, body_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  template <class T>
  void note(T value) {
    std::ostringstream text;
    text.precision(17);
    if constexpr (sizeof value == 1)
      text << int{value};
    else
      text << value;
    values_.push_back(text.str());
  }
  void read_type(const std::string& type) {
    if (short_) return;
    if (type == "u8" || type == "bool" || type.starts_with("enum ")) return note(take<std::uint8_t>());
    if (type == "u16") return note(take<std::uint16_t>());
    if (type == "u32") return note(take<std::uint32_t>());
    if (type == "u64") return note(take<std::uint64_t>());
    if (type == "i64") return note(take<std::int64_t>());
    if (type == "f32") return note(take<float>());
    if (type == "f64") return note(take<double>());
    if (type == "vec3" || type == "quaternion") {
      for (int i = 0; i < (type == "vec3" ? 3 : 4); ++i) note(take<double>());
      return;
    }
    if (type == "vec3f") {
      for (int i = 0; i < 3; ++i) note(take<float>());
      return;
    }
    if (type == "text") {
      const auto size = take<std::uint16_t>();
      if (at_ + size > body_.size()) {
        short_ = true;
        return;
      }
      values_.emplace_back(body_.substr(at_, size));
      at_ += size;
      return;
    }
    if (type.starts_with("array of ")) {
      for (auto left = take<std::uint32_t>(); left > 0 && !short_; --left) read_type(type.substr(9));
      return;
    }
    if (type.starts_with("optional ")) {
      if (take<std::uint8_t>() == 1) read_type(type.substr(9));
      return;
    }
    read(schema().at("structs").at(type));
  }

  std::string_view body_;
  std::size_t at_ = 0;
  bool short_ = false;
  std::vector<std::string> values_;
};

/// The numbers of a message in its order, by the message itself.
class Collector {
 public:
  std::vector<std::string> values;
  template <class T>
  void operator()(const char*, const T& value) {
    note(value);
  }

 private:
  template <class T>
  requires std::is_arithmetic_v<T>
  void note(T value) {
    std::ostringstream text;
    text.precision(17);
    if constexpr (sizeof value == 1)
      text << static_cast<int>(value);
    else
      text << value;
    values.push_back(text.str());
  }
  template <core::NamedEnum E>
  void note(E value) {
    values.push_back(std::to_string(static_cast<int>(value)));
  }
  void note(const std::string& text) { values.push_back(text); }
  void note(const core::Vec3& v) {
    for (const double x : {v.x(), v.y(), v.z()}) note(x);
  }
  void note(const core::Vec3f& v) {
    for (const float x : {v.x(), v.y(), v.z()}) note(x);
  }
  void note(const core::Quat& q) {
    for (const double x : {q.x(), q.y(), q.z(), q.w()}) note(x);
  }
  template <class T>
  void note(const std::vector<T>& all) {
    for (const T& one : all) note(one);
  }
  template <class T>
  void note(const std::shared_ptr<const T>& value) {
    if (value) note(*value);
  }
  template <class T>
  requires requires(const T& t, Collector& c) { fields(t, c); }
  void note(const T& value) { fields(value, *this); }
};

template <class Variant>
void check_by_schema(const std::string& from) {
  rc::check([&from] {
    for_each_type<Variant>([&from](const auto& message) {
      using M = std::decay_t<decltype(message)>;
      const json* described = message_of(kType<M>.id);
      RC_ASSERT(described != nullptr);
      RC_ASSERT((*described)["name"] == kType<M>.name);
      RC_ASSERT((*described)["from"].template get<std::string>().find(from) != std::string::npos);
      const std::string bytes = bytes_of(message);
      SchemaReader reader(frame_of(bytes).body);
      reader.read((*described)["fields"]);
      RC_ASSERT(reader.at_end());
      Collector collector;
      fields(message, collector);
      RC_ASSERT(reader.values() == collector.values);
    });
  });
}

TEST(Schema, ReadsWhatTheEncoderWrites) {
  check_by_schema<ToVehicle>("core");
  check_by_schema<ToCore>("vehicle");
  EXPECT_EQ(schema()["messages"].size(), std::variant_size_v<ToVehicle> + std::variant_size_v<ToCore> - 1)
      << "bye goes both ways";
  EXPECT_EQ(schema()["version"], kVersion);
  EXPECT_EQ(schema()["magic"], kMagic);
}

/// Names of fields, which the bytes do not have.
struct Names {
  std::vector<std::string> names;
  template <class T>
  void operator()(const char* name, const T&) {
    names.emplace_back(name);
  }
};
template <class T>
void expect_names(const json& described) {
  Names names;
  const T value{};
  fields(value, names);
  std::vector<std::string> in_schema;
  for (const json& field : described) in_schema.push_back(field["name"]);
  EXPECT_EQ(in_schema, names.names);
}

TEST(Schema, NamesTheFieldsAsTheCodeDoes) {
  const auto check = [](const auto& message) {
    using M = std::decay_t<decltype(message)>;
    expect_names<M>((*message_of(kType<M>.id))["fields"]);
  };
  rc::check([&] {
    for_each_type<ToVehicle>(check);
    for_each_type<ToCore>(check);
  });
  const json& structs = schema()["structs"];
  expect_names<core::Pose>(structs["pose"]);
  expect_names<core::LidarModel>(structs["lidar_model"]);
  expect_names<core::CameraModel>(structs["camera_model"]);
  expect_names<core::RgbCameraModel>(structs["rgb_camera_model"]);
  expect_names<core::VehicleDescription>(structs["vehicle_description"]);
  expect_names<core::VehicleCheck>(structs["check"]);
  expect_names<core::AttitudeRateCommand>(structs["rates"]);
  expect_names<core::Reference>(structs["reference"]);
  expect_names<core::State>(structs["state"]);
  expect_names<core::ObjectDetection>(structs["detection"]);
  EXPECT_EQ(structs.size(), 10u);
}

template <core::NamedEnum E>
void expect_values(const char* name) {
  std::vector<std::string> by_number;
  for (const auto& value : names_of(E{})) {
    EXPECT_EQ(static_cast<std::size_t>(value.value), by_number.size());
    by_number.emplace_back(value.name);
  }
  EXPECT_EQ(schema()["enums"][name], by_number);
}

TEST(Schema, NumbersTheValuesOfEnumerationsAsTheCodeDoes) {
  expect_values<FlightClock>("clock");
  expect_values<core::Authority>("authority");
  expect_values<core::MissionOutcome>("mission_outcome");
  expect_values<core::ObjectKind>("object_kind");
}

std::string fields_in_words(const json& fields) {
  std::string words;
  for (const json& f : fields)
    words +=
        (words.empty() ? "`" : ", `") + f["name"].get<std::string>() + "` " + f["type"].get<std::string>();
  return words.empty() ? "none" : words;
}

TEST(Schema, IsWhatThePageSays) {
  const std::string page = text_of("vehicle_protocol.md");
  const auto expect_line = [&page](const std::string& line) {
    EXPECT_NE(page.find("\n" + line + "\n"), std::string::npos) << line;
  };
  for (const json& m : schema()["messages"])
    expect_line("| " + std::to_string(m["id"].get<int>()) + " | `" + m["name"].get<std::string>() + "` | " +
                m["from"].get<std::string>() + " | " + m["doc"].get<std::string>() + " | " +
                fields_in_words(m["fields"]) + " |");
  for (const auto& [name, fields] : schema()["structs"].items())
    expect_line("| `" + name + "` | " + fields_in_words(fields) + " |");
  for (const auto& [name, words] : schema()["types"].items())
    expect_line("| " + name + " | " + words.get<std::string>() + " |");
}

}  // namespace
}  // namespace karst::socket
