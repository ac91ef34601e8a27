#pragma once
#include <cstdint>
#include <vector>

#include "engine/beads.h"

namespace dmf::engine {

/// The beads of all microparticles, microparticle by microparticle, each in patches (shell.h). While a pass
/// over pairs runs, images of some stand behind the last one (walls/ghosts.h).
struct BodyBeads {
  AlignedVector<Record> position;      ///< x, y, z; w: A_ls
  AlignedVector<Record> moving;        ///< velocity that the forces see; w: density
  AlignedVector<Record> liquid_force;  ///< force pass writes
  AlignedVector<Record> wall_force;    ///< force pass writes
  AlignedVector<Record> listed;        ///< position when the liquid was sorted; w unused
  std::vector<float> own_density;      ///< what the beads of its own body count
  std::vector<std::uint32_t> key;      ///< of its noise, the same in every step

  std::size_t size() const { return own_density.size(); }
};

}  // namespace dmf::engine
