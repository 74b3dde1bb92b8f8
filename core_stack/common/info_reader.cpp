#include "core_stack/common/info_reader.h"

#include <algorithm>
#include <boost/property_tree/info_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::core {
namespace {

namespace pt = boost::property_tree;

pt::ptree tree_of(const std::vector<InfoLine>& lines, const std::string& source) {
  check_bounds(lines);
  std::stringstream text;
  for (const InfoLine& line : lines) text << line.text << '\n';
  pt::ptree tree;
  try {
    pt::read_info(text, tree);
  } catch (const pt::info_parser_error& e) {
    if (e.line() == 0 || lines.empty()) throw InputError(source, "", e.message());
    const InfoLine& line = lines[std::min<std::size_t>(e.line(), lines.size()) - 1];
    throw InputError(line.file, line.place(), e.message());
  }
  return tree;
}

}  // namespace

pt::ptree read_info(const std::string& file) { return tree_of(info_lines(file, Includes::refuse), file); }

pt::ptree read_including_info(const std::string& file) {
  return tree_of(info_lines(file, Includes::follow), file);
}

pt::ptree parse_info(std::string_view text, const std::string& source) {
  return tree_of(info_lines_of(text, source), source);
}

}  // namespace karst::core
