#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "chip/scene.h"

namespace dmf::chip {

/// Hash of each part of a scene that decides how its run goes: "liquid", "chip", "droplets", ... Equal
/// hashes: a saved run of the one goes on in the other. Comments, order and description of the file, its
/// duration, the limit of beads and the seed (which a run may replace, and saves itself) are in none. Numbers
/// count by their bits, calibrations by their points, board files by the electrodes they give.
using SceneContent = std::map<std::string, std::uint64_t>;

SceneContent content_of(const Scene& scene);

/// Of all parts together; never 0.
std::uint64_t hash_of(const SceneContent& content);

/// The names of the parts in which two contents differ, rising.
std::string differing_parts(const SceneContent& one, const SceneContent& other);

}  // namespace dmf::chip
