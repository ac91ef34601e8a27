#pragma once
#include <string>

namespace dmf::chip {

/// The directory that holds scenes/ and calibration/: what the environment variable DMF_SIM_CONFIG names,
/// else the source tree's config/, else the installed one.
std::string config_directory();

/// Path of a file of the configuration. Something with a slash or that ends in .yaml is a path and is taken
/// as it stands; a bare name is looked up.
/// @param kind "scenes" or "calibration".
/// @throws engine::InvalidInput listing the names that there are.
std::string find_config(const std::string& kind, const std::string& name);

}  // namespace dmf::chip
