#include "engine/observe/solvents.h"

#include <algorithm>
#include <array>

#include "engine/mixture.h"

namespace dmf::engine {

std::vector<std::uint8_t> solvents(const Beads& beads, const Pairs& pairs, const Bonds& bonds) {
  if (beads.species.empty() || bonds.empty()) return {};
  std::vector<bool> known(beads.size(), true);
  const auto note = [&known](const auto& all) {
    for (const auto& one : all)
      for (const std::uint32_t index : one.indices) known[index] = false;
  };
  note(bonds.chains());
  note(bonds.membranes());
  std::vector<std::uint8_t> liquids = beads.species;
  // From the outside in: the core of a micelle has no liquid in range.
  for (std::size_t found = 1; found > 0;) {
    found = 0;
    std::vector<std::array<std::uint16_t, most_liquids>> around(beads.size());
    for (const NeighbourBlock& block : pairs.blocks())
      for_each_pair_in_range(block, [&](std::uint32_t i, std::uint32_t image) {
        const std::uint32_t j = pairs.ghosts().source(image);
        if (!known[i] && known[j]) ++around[i][liquids[j]];
      });
    for (std::size_t i = 0; i < beads.size(); ++i) {
      const auto most = std::max_element(around[i].begin(), around[i].end());
      if (*most == 0) continue;
      liquids[i] = static_cast<std::uint8_t>(most - around[i].begin());
      known[i] = true;
      ++found;
    }
  }
  return liquids;
}

}  // namespace dmf::engine
