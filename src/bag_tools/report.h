#pragma once
#include <string>

#include "bag_tools/bag_record.h"

namespace dmf::bag_tools {

/// What a bag holds of its runs, for people, as `rosbag info` tells it of topics: scene, seed, version,
/// kernel, steps, commands, hashes with the chain's last value, checkpoints, events, and whether each record
/// is complete.
/// @param commands  list every command.
std::string describe(const BagRecord& record, bool commands);

}  // namespace dmf::bag_tools
