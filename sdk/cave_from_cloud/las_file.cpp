#include "sdk/cave_from_cloud/las_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::from_cloud {
namespace {

using core::InputError;
using core::Vec3;
using replay::Field;
using replay::Role;
using replay::ValueType;

constexpr std::size_t kHeaderBytes = 227, kHeaderBytes14 = 375;  // of LAS 1.0 to 1.2, and of 1.4
/// Bytes of a record of each point format; a record may be longer.
constexpr std::array<std::size_t, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

struct LasHeader {
  unsigned minor = 0;  // of the version
  std::uint64_t points_at = 0, points = 0;
  std::size_t format = 0, record_bytes = 0;
  Vec3 scale = Vec3::Ones(), offset = Vec3::Zero();
};

/// An unsigned whole number; LAS files are little-endian.
std::uint64_t whole_at(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

Vec3 three_numbers_at(const std::string& bytes, std::size_t at) {
  const auto number = [&](std::size_t i) { return std::bit_cast<double>(whole_at(bytes, at + 8 * i, 8)); };
  return {number(0), number(1), number(2)};
}

std::string byte(std::uint64_t at) { return "byte " + std::to_string(at); }

std::string header_bytes(const std::string& path, std::ifstream& in, std::uint64_t file_bytes) {
  std::string head(kHeaderBytes14, '\0');
  in.read(head.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(head.size(), file_bytes)));
  head.resize(static_cast<std::size_t>(in.gcount()));
  if (!head.starts_with("LASF")) throw InputError(path, byte(0), "is no LAS file: expected \"LASF\"");
  if (head.size() < kHeaderBytes)
    throw InputError(path, byte(head.size()),
                     "the file is truncated: the header of a LAS file has at least 227 bytes");
  const std::uint64_t major = whole_at(head, 24, 1), minor = whole_at(head, 25, 1);
  if (major != 1 || minor > 4)
    throw InputError(
        path, byte(24),
        "is LAS " + std::to_string(major) + "." + std::to_string(minor) + "; versions 1.0 to 1.4 are read");
  if (minor == 4 && head.size() < kHeaderBytes14)
    throw InputError(path, byte(head.size()),
                     "the file is truncated: the header of a LAS 1.4 file has 375 bytes");
  return head;
}

/// The number of points: of LAS 1.4 a long one, beside the short one of the other versions.
std::uint64_t points_of(const std::string& path, const std::string& head, unsigned minor) {
  const std::uint64_t points = whole_at(head, 107, 4);
  if (minor < 4) return points;
  const std::uint64_t points14 = whole_at(head, 247, 8);
  if (points != 0 && points14 != 0 && points != points14)
    throw InputError(path, byte(247),
                     "its header declares " + std::to_string(points14) + " points, and " +
                         std::to_string(points) + " for readers of earlier versions");
  return std::max(points, points14);
}

LasHeader read_las_header(const std::string& path, std::ifstream& in, std::uint64_t file_bytes) {
  const std::string head = header_bytes(path, in, file_bytes);
  LasHeader h;
  h.minor = static_cast<unsigned>(whole_at(head, 25, 1));
  h.points_at = whole_at(head, 96, 4);
  h.format = whole_at(head, 104, 1);
  h.record_bytes = whole_at(head, 105, 2);
  h.points = points_of(path, head, h.minor);
  h.scale = three_numbers_at(head, 131);
  h.offset = three_numbers_at(head, 155);
  constexpr std::size_t kCompressed = 0xc0;  // bits that LASzip sets
  if ((h.format & kCompressed) != 0)
    throw InputError(path, byte(104), "is compressed (LAZ): unpack it with `laszip -i FILE.laz -o FILE.las`");
  if (h.format >= kRecordBytes.size())
    throw InputError(path, byte(104), "point format " + std::to_string(h.format) + " is not known");
  if (h.record_bytes < kRecordBytes[h.format])
    throw InputError(path, byte(105),
                     "records of " + std::to_string(h.record_bytes) + " bytes; point format " +
                         std::to_string(h.format) + " needs " + std::to_string(kRecordBytes[h.format]));
  if (const std::uint64_t end = std::max<std::uint64_t>(whole_at(head, 94, 2), kHeaderBytes);
      h.points_at < end)
    throw InputError(path, byte(96),
                     "its points begin at byte " + std::to_string(h.points_at) + ", within the header of " +
                         std::to_string(end) + " bytes");
  const std::uint64_t there =
      file_bytes > h.points_at ? (file_bytes - h.points_at) / h.record_bytes : std::uint64_t{0};
  if (h.points > there)
    throw InputError(path, byte(file_bytes),
                     "the file is truncated: its header declares " + std::to_string(h.points) +
                         " points of " + std::to_string(h.record_bytes) + " bytes, of which " +
                         std::to_string(there) + " are there");
  if (!h.scale.allFinite() || !h.offset.allFinite() || h.scale.cwiseAbs().minCoeff() == 0)
    throw InputError(path, byte(131), "scale and offset must be finite numbers, and the scale not 0");
  return h;
}

bool is_withheld(const LasHeader& h, const std::string& records, std::size_t at) {
  constexpr unsigned kFlags = 15;  // byte of the record
  const auto flags = static_cast<unsigned char>(records[at + kFlags]);
  if (h.format >= 6) return (flags & 0x04) != 0;
  return h.minor >= 1 && (flags & 0x80) != 0;
}

}  // namespace

std::size_t read_las(const std::string& path, replay::PointSink& sink) {
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
  constexpr std::array kCoordinates{Role::x, Role::y, Role::z};
  std::ifstream in = core::open_input(path, core::kMaxDataFileBytes);
  in.seekg(0, std::ios::end);
  const auto file_bytes = static_cast<std::uint64_t>(in.tellg());
  in.seekg(0);
  const LasHeader h = read_las_header(path, in, file_bytes);
  std::vector<Field> fields;
  for (const Role role : kCoordinates) fields.push_back({role, ValueType::float64, 0, 0});
  sink.begin(fields);
  in.clear();  // a file shorter than the header of LAS 1.4
  in.seekg(static_cast<std::streamoff>(h.points_at));
  std::size_t withheld = 0;
  std::string records;
  for (std::uint64_t left = h.points; left > 0;) {
    const std::uint64_t n =
        std::min<std::uint64_t>(left, std::max<std::size_t>(1, kPieceBytes / h.record_bytes));
    records.resize(static_cast<std::size_t>(n) * h.record_bytes);
    in.read(records.data(), static_cast<std::streamsize>(records.size()));
    if (static_cast<std::size_t>(in.gcount()) != records.size())
      throw InputError(path, "", "cannot be read: it became shorter meanwhile");
    for (std::size_t at = 0; at < records.size(); at += h.record_bytes) {
      if (is_withheld(h, records, at)) {
        ++withheld;
        continue;
      }
      for (std::size_t i = 0; i < kCoordinates.size(); ++i) {
        const auto stored =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(whole_at(records, at + 4 * i, 4)));
        const auto axis = static_cast<Eigen::Index>(i);
        sink.set(kCoordinates[i], stored * h.scale[axis] + h.offset[axis]);
      }
      sink.end_point();
    }
    left -= n;
  }
  return withheld;
}

}  // namespace karst::from_cloud
