// The blocks of a cave's .info file, and their numbers. All functions throw InputError naming file and key.
#pragma once
#include <boost/property_tree/ptree_fwd.hpp>

#include "plugins/simulator/cave/cave.h"

namespace karst::cave {

/// "x y z"
core::Vec3 read_vector(const std::string& source, const std::string& key, const std::string& text);
/// "x y z [heading_deg]"
StartPose read_start(const std::string& source, const std::string& text);
Patch read_patch(const std::string& source, const boost::property_tree::ptree& tree);
OreBody read_ore(const std::string& source, const boost::property_tree::ptree& tree);
LooseRock read_loose_rock(const std::string& source, const boost::property_tree::ptree& tree);
Cloud read_cloud(const std::string& source, const boost::property_tree::ptree& tree);
Fault read_fault(const std::string& source, const boost::property_tree::ptree& tree);
CaveObject read_object(const std::string& source, const boost::property_tree::ptree& tree);

}  // namespace karst::cave
