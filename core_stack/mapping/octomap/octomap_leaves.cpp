// Reads OctoMap's two file formats. OctoMap's own reader does not detect truncated files, and a damaged file
// can make it recurse without limit.
#include "core_stack/mapping/octomap/octomap_leaves.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"

namespace karst::core {
namespace {

constexpr std::int32_t kWorldEdge = 65536;  // cells; OctoMap's trees have 16 levels
constexpr double kMaxKnownCells = 3e8;      // 600 MB; a file with more is damaged

struct Header {
  bool binary = false;  // a .bt file: classes only
  double resolution_m = 0;
  std::uint64_t nodes = 0;
};

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), in_(open_input(path, kMaxDataFileBytes)) {}

  MapLeaves read() {
    const Header header = read_header();
    const MapOptions options;
    const auto logit = [](double p) { return static_cast<float>(std::log(p / (1 - p))); };
    free_ = logit(options.min_probability);
    occupied_ = logit(options.max_probability);
    if (header.nodes > 0) {
      const CellKey low{-kWorldEdge / 2, -kWorldEdge / 2, -kWorldEdge / 2};
      header.binary ? read_classes(low, kWorldEdge) : read_values(low, kWorldEdge);
      nodes_ += header.binary ? 1 : 0;  // the root has no entry of its own in .bt
    }
    if (nodes_ != header.nodes)
      fail(place(), "holds " + std::to_string(nodes_) + " nodes where its header says " +
                        std::to_string(header.nodes));
    return {header.resolution_m, std::move(leaves_)};
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& reason) const {
    throw InputError(path_, where, reason);
  }
  std::string place() { return "byte " + std::to_string(bytes_); }

  std::string line() {
    std::string text;
    if (!std::getline(in_, text)) fail(place(), "ends within its header");
    bytes_ += text.size() + 1;
    return text;
  }

  Header read_header() {
    Header header;
    const std::string first = line();
    header.binary = first.starts_with("# Octomap OcTree binary file");
    if (!header.binary && !first.starts_with("# Octomap OcTree file"))
      fail("line 1", "is no OctoMap .bt or .ot file");
    for (std::string text = line(); text != "data"; text = line()) {
      std::istringstream words(text);
      std::string key, id;
      words >> key;
      if (key == "id" && words >> id && id != "OcTree")
        fail("id", "expected a tree of kind OcTree, got " + id);
      if (key == "size" && !(words >> header.nodes)) fail("size", "expected a number of nodes");
      if (key == "res" && !(words >> header.resolution_m)) fail("res", "expected the edge length of a cell");
    }
    if (!(header.resolution_m >= 1e-4 && header.resolution_m <= 1e4))
      fail("res", "expected the edge length of a cell, in metres");
    return header;
  }

  template <class T>
  T take() {
    std::array<char, sizeof(T)> raw;
    if (!in_.read(raw.data(), raw.size())) fail(place(), "ends within its tree");
    bytes_ += raw.size();
    return std::bit_cast<T>(raw);
  }

  void leaf(const CellKey& low, std::int32_t edge, float log_odds) {
    cells_ += std::pow(static_cast<double>(edge), 3);
    if (cells_ > kMaxKnownCells) fail(place(), "says more than 300 million cells are known");
    leaves_.push_back({low, edge, log_odds});
  }

  static CellKey child(const CellKey& low, std::int32_t half, unsigned i) {
    return {low.x + (i & 1 ? half : 0), low.y + (i & 2 ? half : 0), low.z + (i & 4 ? half : 0)};
  }

  /// .bt: two bits per child (1 free, 2 occupied, 3 with children), then the children's entries.
  void read_classes(const CellKey& low, std::int32_t edge) {
    if (edge == 1) fail(place(), "has a tree deeper than 16 levels");
    const auto kinds = take<std::uint16_t>();
    const std::int32_t half = edge / 2;
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned kind = kinds >> (2 * i) & 3;
      nodes_ += kind != 0;
      if (kind == 1 || kind == 2) leaf(child(low, half, i), half, kind == 1 ? free_ : occupied_);
    }
    for (unsigned i = 0; i < 8; ++i)
      if ((kinds >> (2 * i) & 3) == 3) read_classes(child(low, half, i), half);
  }

  /// .ot: a node's log-odds and a bit mask of its children, then the children.
  void read_values(const CellKey& low, std::int32_t edge) {
    const auto log_odds = take<float>();
    const auto children = take<std::uint8_t>();
    ++nodes_;
    if (!std::isfinite(log_odds)) fail(place(), "holds a log-odds value that is no number");
    if (children == 0) return leaf(low, edge, log_odds);
    if (edge == 1) fail(place(), "has a tree deeper than 16 levels");
    for (unsigned i = 0; i < 8; ++i)
      if (children >> i & 1) read_values(child(low, edge / 2, i), edge / 2);
  }

  std::string path_;
  std::ifstream in_;
  std::uint64_t bytes_ = 0, nodes_ = 0;
  double cells_ = 0;
  std::vector<MapLeaf> leaves_;
  float free_ = 0, occupied_ = 0;
};

}  // namespace

MapLeaves read_leaves(const std::string& path) { return Reader(path).read(); }

}  // namespace karst::core
