#include "engine/observe/temperature.h"

#include "engine/parameters.h"

namespace dmf::engine {
namespace {
Vector3d velocity_of(const Record& record) { return {record.x, record.y, record.z}; }
}  // namespace

double kinetic_temperature(const Beads& beads, int dimensions) {
  double twice_energy = 0;
  for (const Record& v : beads.velocity) twice_energy += velocity_of(v).squaredNorm();
  return beads.size() > 0
             ? twice_energy / (static_cast<double>(dimensions) * static_cast<double>(beads.size()))
             : 0.0;
}

double local_temperature(const Beads& beads, const std::vector<NeighbourBlock>& blocks, int dimensions) {
  double twice_energy = 0, freedoms = 0;
  for (const NeighbourBlock& block : blocks)
    for (const NeighbourCell& cell : block.cells) {
      Vector3d mean = Vector3d::Zero();
      for (std::uint32_t i = cell.begin; i < cell.end; ++i) mean += velocity_of(beads.velocity[i]);
      mean /= static_cast<double>(cell.end - cell.begin);
      for (std::uint32_t i = cell.begin; i < cell.end; ++i)
        twice_energy += (velocity_of(beads.velocity[i]) - mean).squaredNorm();
      freedoms += dimensions * static_cast<double>(cell.end - cell.begin - 1);
    }
  return freedoms > 0 ? twice_energy / freedoms : 0.0;
}

}  // namespace dmf::engine
