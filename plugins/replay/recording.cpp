#include "plugins/replay/recording.h"

#include <algorithm>

#include "core_stack/common/error.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "plugins/replay/scan_files/text_numbers.h"
#include "plugins/replay/sweep_of_scan.h"

namespace karst::replay {
namespace {

using core::InputError;
using core::TimeNs;
namespace fs = std::filesystem;

/// The text that `*` matches, if `name` matches a pattern with at most one `*`.
std::optional<std::string> match(const std::string& pattern, const std::string& name) {
  const auto star = pattern.find('*');
  if (star == std::string::npos) return name == pattern ? std::optional(name) : std::nullopt;
  const std::string head = pattern.substr(0, star), tail = pattern.substr(star + 1);
  if (name.size() < head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail))
    return std::nullopt;
  return name.substr(head.size(), name.size() - head.size() - tail.size());
}

/// Natural order of names: 2 before 10.
bool before(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    const auto number = [&](const std::string& s, std::size_t& at) {
      while (at + 1 < s.size() && s[at] == '0' && digit(s[at + 1])) ++at;
      const std::size_t begin = at;
      while (at < s.size() && digit(s[at])) ++at;
      return std::string_view(s).substr(begin, at - begin);
    };
    const std::string_view m = number(a, i), n = number(b, j);
    if (m.size() != n.size()) return m.size() < n.size();
    if (m != n) return m < n;
  }
  return a.size() - i < b.size() - j || (a.size() - i == b.size() - j && a < b);
}

std::vector<RecordedFile> find_files(const Recording& r) {
  const std::string place = r.info_file.empty() ? r.folder.string() : r.info_file;
  std::vector<std::pair<std::string, std::string>> found;  // name, what * stands for
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(r.folder, error)) {
    const std::string name = entry.path().filename().string();
    const auto part = match(r.info.scans, name);
    if (part && is_scan_file(name) && entry.is_regular_file()) found.emplace_back(name, *part);
  }
  if (error) throw InputError(r.folder.string(), "", "cannot be read: " + error.message());
  if (found.empty())
    throw InputError(r.folder.string(), "",
                     "holds no scan: no .pcd, .ply or .bin file fits scans \"" + r.info.scans +
                         "\", and no bag (.bag, .mcap, .db3)");
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return before(a.first, b.first); });
  std::vector<RecordedFile> files;
  for (const auto& [name, part] : found) {
    RecordedFile f{r.folder / name, {}, 0};
    if (std::string pattern = r.info.point_times_files; !pattern.empty()) {
      const auto star = pattern.find('*');
      if (star != std::string::npos) pattern.replace(star, 1, part);
      f.point_times = r.folder / pattern;
      if (!fs::is_regular_file(f.point_times))
        throw InputError(place, "point_times.files", "no file " + pattern + " for the scan " + name);
    }
    files.push_back(std::move(f));
  }
  return files;
}

/// The number a file's name ends with: "scan_1647090478.71.pcd" has 1647090478.71.
std::string number_in(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return "";
  auto first = stem.find_last_not_of("0123456789.", last);
  first = stem.find_first_of("0123456789", first == std::string::npos ? 0 : first);
  return stem.substr(first, last + 1 - first);
}

void stamp_from_file(Recording& r) {
  const fs::path file = r.folder / r.info.stamp_file;
  const std::string text = file_bytes(file.string());
  TextReader reader(text);
  std::size_t count = 0;
  for (std::string_view line; reader.line(line);) {
    const std::string_view word = next_word(line);
    if (word.empty() || word.starts_with('#')) continue;
    const auto stamp = parse_time(word, nanoseconds_of(r.info.stamp_unit));
    if (!stamp)
      throw InputError(file.string(), "line " + std::to_string(reader.number()),
                       "expected a stamp, got \"" + std::string(word) + "\"");
    if (count < r.files.size()) r.files[count].stamp = *stamp;
    ++count;
  }
  if (count != r.files.size())
    throw InputError(
        file.string(), "",
        "holds " + std::to_string(count) + " stamps for " + std::to_string(r.files.size()) + " scans");
}

void stamp(Recording& r) {
  if (r.info.stamp_from == StampSource::file) stamp_from_file(r);
  for (std::size_t i = 0; i < r.files.size(); ++i) {
    RecordedFile& f = r.files[i];
    if (r.info.stamp_from == StampSource::rate)
      f.stamp = core::from_seconds(static_cast<double>(i) / r.info.stamp_rate_hz);
    if (r.info.stamp_from == StampSource::names) {
      const auto t = parse_time(number_in(f.path), nanoseconds_of(r.info.stamp_unit));
      if (!t) throw InputError(f.path.string(), "", "its name ends with no number that is a stamp");
      f.stamp = *t;
    }
    if (i > 0 && f.stamp <= r.files[i - 1].stamp)
      throw InputError(f.path.string(), "",
                       "its stamp " + decimal_seconds(f.stamp) +
                           " s is not after that of the scan before it, " +
                           decimal_seconds(r.files[i - 1].stamp) + " s");
  }
}

/// Reads each point's time from a separate file.
void take_point_times(const Recording& r, const RecordedFile& f, std::size_t declared, Scan& scan) {
  const std::string bytes = file_bytes(f.point_times.string());
  const ValueType type = r.layout.point_times_type;
  if (bytes.size() != declared * size_of(type) || scan.dropped > 0)
    throw InputError(f.point_times.string(), "byte " + std::to_string(bytes.size()),
                     "holds " + std::to_string(bytes.size() / size_of(type)) + " times for " +
                         std::to_string(declared) + " points" +
                         (scan.dropped > 0 ? ", some of which are not finite" : ""));
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    scan.points[i].time = value_at(bytes.data() + i * size_of(type), type, std::endian::little);
  scan.has_time = true;
  scan.time_is_whole = is_whole(type);
}

}  // namespace

Recording open_recording(const fs::path& folder, const std::string& info_file) {
  if (!fs::is_directory(folder)) throw InputError(folder.string(), "", "no such folder of scans");
  Recording r;
  r.folder = folder;
  r.info_file = info_file;
  if (info_file.empty() && fs::exists(folder / "recording.info"))
    r.info_file = (folder / "recording.info").string();
  if (!r.info_file.empty()) r.info = read_recording_info(r.info_file);
  r.layout = layout_of(r.info, r.info_file);
  r.files = find_files(r);
  stamp(r);
  return r;
}

core::Sweep read_sweep(const Recording& r, std::size_t i, ReadNotes* notes) {
  const RecordedFile& f = r.files.at(i);
  Scan scan = read_scan(f.path.string(), r.info.fields, r.layout.bin);
  if (!f.point_times.empty()) take_point_times(r, f, scan.points.size() + scan.dropped, scan);
  return sweep_of(std::move(scan), f.stamp, {f.path.string(), ""}, r.info, r.layout, notes);
}

std::optional<ImuFile> open_imu(const Recording& r) {
  if (r.info.imu_file.empty()) return std::nullopt;
  return ImuFile((r.folder / r.info.imu_file).string(), r.info.imu_columns, nanoseconds_of(r.info.imu_unit),
                 r.layout.R_body_imu);
}

FolderSensors::FolderSensors(Recording recording)
    : recording_(std::move(recording)), imu_(open_imu(recording_)) {}

core::TimeNs FolderSensors::begin() const {
  return recording_.files.front().stamp - core::from_seconds(recording_.info.period_s);
}

std::optional<core::Sweep> FolderSensors::next_sweep(ReadNotes& notes) {
  if (next_ == recording_.files.size()) return std::nullopt;
  notes.stamp = recording_.files[next_].stamp;
  return read_sweep(recording_, next_++, &notes);
}

std::optional<core::ImuSample> FolderSensors::next_imu() { return imu_ ? imu_->next() : std::nullopt; }

}  // namespace karst::replay
