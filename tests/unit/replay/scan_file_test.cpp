// Each format against the points it was written from, and damaged files of all kinds.
#include "plugins/replay/scan_files/scan_file.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/error.h"
#include "plugins/replay/scan_files/lzf.h"
#include "tests/unit/replay/folder.h"

namespace karst::replay {
namespace {

using core::InputError;
using core::Vec3f;
using test::Folder;
using test::put;

struct Row {
  float x, y, z, intensity;
  std::uint16_t ring;
  double t;
};
const std::vector<Row> kRows = {{1.5f, -2.25f, 3.0f, 10.0f, 0, 0.0},
                                {-4.0f, 5.5f, 0.125f, 20.0f, 3, 0.0625},
                                {7.75f, 0.5f, -6.5f, 30.0f, 15, 0.09375}};

std::string pcd_header(const std::string& data, std::size_t points) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity ring t\nSIZE 4 4 4 "
         "4 2 8\n"
         "TYPE F F F F U F\nCOUNT 1 1 1 1 1 1\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) +
         "\nDATA " + data + "\n";
}

std::string records(const std::vector<Row>& rows) {
  std::string bytes;
  for (const Row& r : rows) {
    for (const float v : {r.x, r.y, r.z, r.intensity}) put(bytes, v);
    put(bytes, r.ring);
    put(bytes, r.t);
  }
  return bytes;
}

std::string columns(const std::vector<Row>& rows) {
  std::string bytes;
  for (const auto field : {&Row::x, &Row::y, &Row::z, &Row::intensity})
    for (const Row& r : rows) put(bytes, r.*field);
  for (const Row& r : rows) put(bytes, r.ring);
  for (const Row& r : rows) put(bytes, r.t);
  return bytes;
}

/// A plain LZF packer: the longest repetition in the last 8 kB, by trying all.
std::string lzf_pack(const std::string& in) {
  std::string out, plain;
  const auto flush = [&] {
    for (std::size_t at = 0; at < plain.size(); at += 32) {
      const std::string part = plain.substr(at, 32);
      out.push_back(static_cast<char>(part.size() - 1));
      out += part;
    }
    plain.clear();
  };
  for (std::size_t at = 0; at < in.size();) {
    std::size_t best = 0, back = 0;
    for (std::size_t from = at > 8191 ? at - 8191 : 0; from < at; ++from) {
      std::size_t n = 0;
      while (n < 264 && at + n < in.size() && in[from + n] == in[at + n]) ++n;
      if (n > best) best = n, back = at - from;
    }
    if (best < 3) {
      plain.push_back(in[at++]);
      continue;
    }
    flush();
    const std::size_t length = best - 2, offset = back - 1;
    if (length < 7) {
      out.push_back(static_cast<char>(length << 5 | offset >> 8));
    } else {
      out.push_back(static_cast<char>(7 << 5 | offset >> 8));
      out.push_back(static_cast<char>(length - 7));
    }
    out.push_back(static_cast<char>(offset & 255));
    at += best;
  }
  flush();
  return out;
}

std::string compressed(const std::vector<Row>& rows) {
  const std::string raw = columns(rows), packed = lzf_pack(raw);
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(packed.size()));
  put(bytes, static_cast<std::uint32_t>(raw.size()));
  return bytes + packed;
}

std::string ascii(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& r : rows) {
    char line[200];
    std::snprintf(line, sizeof line, "%.9g %.9g %.9g %.9g %d %.17g\n", r.x, r.y, r.z, r.intensity, r.ring,
                  r.t);
    text += line;
  }
  return text;
}

void expect_rows(const Scan& scan, const std::vector<Row>& rows) {
  ASSERT_EQ(scan.points.size(), rows.size());
  EXPECT_TRUE(scan.has_intensity && scan.has_ring && scan.has_time);
  EXPECT_FALSE(scan.time_is_whole);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(scan.points[i].position, Vec3f(rows[i].x, rows[i].y, rows[i].z));
    EXPECT_EQ(scan.points[i].intensity, rows[i].intensity);
    EXPECT_EQ(scan.points[i].ring, rows[i].ring);
    EXPECT_EQ(scan.points[i].time, rows[i].t);
  }
}

std::string error_of(const std::string& file) {
  try {
    read_scan(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return "read";
}

TEST(ScanFile, AllThreeKindsOfPcdHoldTheSamePoints) {
  Folder dir;
  expect_rows(read_scan(dir.write("a.pcd", pcd_header("ascii", 3) + ascii(kRows))), kRows);
  expect_rows(read_scan(dir.write("b.pcd", pcd_header("binary", 3) + records(kRows))), kRows);
  expect_rows(read_scan(dir.write("c.pcd", pcd_header("binary_compressed", 3) + compressed(kRows))), kRows);
}

TEST(ScanFile, CompressionThatRepeatsItselfIsUndone) {
  Folder dir;
  std::vector<Row> rows;
  for (int i = 0; i < 3000; ++i)
    rows.push_back({static_cast<float>(i % 7), 1.0f, static_cast<float>(i / 100), 5.0f,
                    static_cast<std::uint16_t>(i % 16), 0.5});
  const std::string bytes = compressed(rows);
  ASSERT_LT(bytes.size(), columns(rows).size() / 10) << "the packer found no repetition: nothing is tested";
  expect_rows(read_scan(dir.write("c.pcd", pcd_header("binary_compressed", rows.size()) + bytes)), rows);
}

RC_GTEST_PROP(Lzf, UndoesThePacker, ()) {
  const auto text = *rc::gen::container<std::string>(rc::gen::inRange<char>('a', 'd'));
  const std::string packed = lzf_pack(text);
  const auto out = lzf_decompress(packed, text.size());
  RC_ASSERT(out.has_value());
  RC_ASSERT(*out == text);
}

RC_GTEST_PROP(Lzf, OfAnyBytesNeverWritesMoreThanAsked, ()) {
  const auto bytes = *rc::gen::arbitrary<std::string>();
  const auto size = *rc::gen::inRange<std::size_t>(0, 2000);
  const auto out = lzf_decompress(bytes, size);
  RC_ASSERT(!out || out->size() == size);
}

TEST(ScanFile, PlyOfEitherByteOrderAndText) {
  Folder dir;
  const std::string properties =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "scalar_intensity\n"
      "property ushort ring\nproperty double time\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  std::string swapped;
  for (const Row& r : kRows) {
    const auto add = [&](auto v) {
      std::string raw;
      put(raw, v);
      swapped.append(raw.rbegin(), raw.rend());
    };
    for (const float v : {r.x, r.y, r.z, r.intensity}) add(v);
    add(r.ring), add(r.t);
  }
  expect_rows(
      read_scan(dir.write("a.ply", "ply\nformat ascii 1.0\n" + properties + ascii(kRows) + "3 0 1 2\n")),
      kRows);
  expect_rows(
      read_scan(dir.write("l.ply", "ply\nformat binary_little_endian 1.0\n" + properties + records(kRows))),
      kRows);
  expect_rows(read_scan(dir.write("b.ply", "ply\nformat binary_big_endian 1.0\n" + properties + swapped)),
              kRows);
  EXPECT_EQ(ply_faces((dir.path() / "a.ply").string()), 1u);
}

TEST(ScanFile, KittiRecordsAndLayoutsOfOnesOwn) {
  Folder dir;
  std::string kitti;
  for (const Row& r : kRows)
    for (const float v : {r.x, r.y, r.z, r.intensity}) put(kitti, v);
  const Scan scan = read_scan(dir.write("k.bin", kitti));
  ASSERT_EQ(scan.points.size(), 3u);
  EXPECT_EQ(scan.points[1].position, Vec3f(-4.0f, 5.5f, 0.125f));
  EXPECT_EQ(scan.points[2].intensity, 30.0f);
  const BinLayout layout{{"x", "y", "z", "intensity", "ring", "t"},
                         {ValueType::float32, ValueType::float32, ValueType::float32, ValueType::float32,
                          ValueType::uint16, ValueType::float64}};
  expect_rows(read_scan(dir.write("own.bin", records(kRows)), {}, layout), kRows);
}

/// What a file gives, value by value.
class Values final : public PointSink {
 public:
  std::vector<Role> roles;
  std::vector<ValueType> types;
  std::vector<double> all;
  std::size_t points = 0;
  void begin(std::span<const Field> fields) override {
    for (const Field& f : fields) {
      roles.push_back(f.role);
      types.push_back(f.type);
    }
  }
  void set(Role, double value) override { all.push_back(value); }
  void end_point() override { ++points; }
};

TEST(ScanFile, ASinkGetsNormalsAndAllDigits) {
  Folder dir;
  const std::string fields =
      "FIELDS x y z nx Normal_Y nz\nSIZE 8 8 8 4 4 4\nTYPE F F F F F F\nPOINTS 1\nDATA ";
  const std::vector<double> place{672001.0001, 5200000.0002, 3.25}, normal{0, 0.5, -1};
  std::string bytes;
  for (const double v : place) put(bytes, v);
  for (const double v : normal) put(bytes, static_cast<float>(v));
  std::vector<double> expected = place;
  expected.insert(expected.end(), normal.begin(), normal.end());
  for (const auto& [file, type] :
       {std::pair{dir.write("b.pcd", fields + "binary\n" + bytes), ValueType::float32},
        {dir.write("a.pcd", fields + "ascii\n672001.0001 5200000.0002 3.25 0 0.5 -1\n"),
         ValueType::float64}}) {
    Values values;
    read_pcd(file, {}, values);
    EXPECT_EQ(values.points, 1u);
    EXPECT_EQ(values.all, expected) << file;
    EXPECT_EQ(values.roles,
              (std::vector<Role>{Role::x, Role::y, Role::z, Role::normal_x, Role::normal_y, Role::normal_z}));
    EXPECT_EQ(values.types.front(), ValueType::float64);
    EXPECT_EQ(values.types.back(), type) << "text is never rounded to single precision";
  }
}

TEST(ScanFile, PointsThatAreNotFiniteAreLeftOutAndCounted) {
  Folder dir;
  std::vector<Row> rows = kRows;
  rows[0].y = std::numeric_limits<float>::quiet_NaN();
  rows[2].z = std::numeric_limits<float>::infinity();
  for (const auto& [name, data] :
       {std::pair<std::string, std::string>{"ascii", ascii(rows)}, {"binary", records(rows)}}) {
    const Scan scan = read_scan(dir.write(name + ".pcd", pcd_header(name, 3) + data));
    EXPECT_EQ(scan.points.size(), 1u);
    EXPECT_EQ(scan.dropped, 2u);
  }
}

TEST(ScanFile, CutAnywhereItIsAnErrorThatNamesTheFileOrTheWholeCloud) {
  Folder dir;
  for (const auto& [name, bytes] :
       {std::pair<std::string, std::string>{"a.pcd", pcd_header("ascii", 3) + ascii(kRows)},
        {"b.pcd", pcd_header("binary", 3) + records(kRows)},
        {"c.pcd", pcd_header("binary_compressed", 3) + compressed(kRows)},
        {"d.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nproperty float i\nproperty ushort ring\nproperty double t\nend_header\n" +
             records(kRows)}})
    for (std::size_t n = 0; n + 1 < bytes.size(); ++n) {
      const std::string file = dir.write(name, bytes.substr(0, n));
      const std::string error = error_of(file);
      // A last number cut short is still a number: text cannot tell.
      if (name == "a.pcd" && bytes.size() - n < 12 && error == "read") continue;
      EXPECT_EQ(error.rfind(file, 0), 0u) << name << " cut to " << n << " bytes: " << error;
    }
}

// Lines were passed over long after the file's end.
TEST(ScanFile, APlyElementOfNothingWithACountWithoutEndIsPassedOverAtOnce) {
  Folder dir;
  EXPECT_NE(error_of(dir.write("n.ply",
                               "ply\nformat ascii 1.0\nelement empty 18446744073709551615\nelement vertex 1\n"
                               "property float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n"))
                .find("the file is truncated"),
            std::string::npos);
}

TEST(ScanFile, HugeClaimsAreRefusedBeforeAnyMemoryIsGiven) {
  Folder dir;
  const std::string huge = "18446744073709551615";
  const auto header = [&](const std::string& data) {
    std::string h = pcd_header(data, 3);
    for (std::size_t at; (at = h.find(" 3\n")) != std::string::npos;) h.replace(at, 3, " " + huge + "\n");
    return h;
  };
  EXPECT_NE(error_of(dir.write("b.pcd", header("binary") + records(kRows))).find("truncated"),
            std::string::npos);
  EXPECT_NE(error_of(dir.write("a.pcd", header("ascii") + ascii(kRows))).find("truncated"),
            std::string::npos);
  EXPECT_NE(error_of(dir.write("c.pcd", header("binary_compressed") + compressed(kRows))).find("declares"),
            std::string::npos);
  std::string claim;
  put(claim, std::uint32_t{4});
  put(claim, std::uint32_t{4200000000u / 26 * 26});
  EXPECT_NE(error_of(dir.write("d.pcd", pcd_header("binary_compressed", 4200000000u / 26) + claim + "abcd"))
                .find("damaged"),
            std::string::npos);
  EXPECT_NE(error_of(dir.write("e.ply",
                               "ply\nformat binary_little_endian 1.0\nelement vertex " + huge +
                                   "\nproperty float x\nproperty float y\nproperty float z\nend_header\nabc"))
                .find("truncated"),
            std::string::npos);
}

TEST(ScanFile, WhatIsNoCloudSaysWhy) {
  Folder dir;
  EXPECT_NE(error_of("/nowhere/x.pcd").find("cannot be opened"), std::string::npos);
  EXPECT_NE(error_of(dir.write("x.txt", "")).find("must be a .pcd"), std::string::npos);
  EXPECT_NE(error_of(dir.write("x.pcd", "hello\n")).find("no line DATA"), std::string::npos);
  EXPECT_NE(error_of(dir.write("y.pcd", "FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nPOINTS 0\nDATA ascii\n"))
                .find("no field z"),
            std::string::npos);
  EXPECT_NE(error_of(dir.write("z.pcd", "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nPOINTS 0\nDATA ascii\n"))
                .find("as many entries"),
            std::string::npos);
  EXPECT_NE(error_of(dir.write("w.pcd", pcd_header("zipped", 3))).find("DATA must be"), std::string::npos);
  EXPECT_NE(error_of(dir.write("v.pcd", pcd_header("ascii", 1) + "1 2 three 4 5 6\n")).find("line 12"),
            std::string::npos);
  EXPECT_NE(error_of(dir.write("v.bin", "12345")).find("no multiple"), std::string::npos);
  std::filesystem::create_directory(dir.path() / "f.pcd");
  EXPECT_NE(error_of((dir.path() / "f.pcd").string()).find("is a directory"), std::string::npos);
}

}  // namespace
}  // namespace karst::replay
