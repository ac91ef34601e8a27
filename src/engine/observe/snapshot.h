#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/chain.h"
#include "engine/membrane.h"
#include "engine/microparticle.h"
#include "engine/observe/stress_profile.h"
#include "engine/observe/wetted_area.h"

namespace dmf::engine {

using Eigen::Vector3d;

/// One droplet as the tracker last saw it. Reduced units, angles in degrees.
struct DropletObservation {
  std::uint32_t id = 0;       ///< from 1, persistent, never used twice in a run
  std::uint32_t species = 0;  ///< number of its liquid (mixture.h)
  std::vector<std::uint32_t>
      parents;  ///< droplets that it came from by merge or split; empty for a dispensed one
  std::size_t beads = 0;
  Vector3d centroid = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();  ///< mean bead velocity, averaged over the angle window
  Vector3d lower = Vector3d::Zero();     ///< bounding box
  Vector3d upper = Vector3d::Zero();
  double volume = 0;                       ///< beads / bulk density, r_c^3
  double footprint_area = 0;               ///< wetted wall area, r_c^2; 0 when it does not touch the wall
  double height = 0;                       ///< top above the wall plane, r_c
  std::vector<Eigen::Vector2f> footprint;  ///< convex outline of the wetted area, counter-clockwise, (x, y)
  std::optional<double> contact_angle;     ///< mean of both; absent until the window holds enough samples
  std::optional<double> advancing_angle;   ///< on the side that it moves to (+x while at rest)
  std::optional<double> receding_angle;
};

/// Something that happened to droplets, at the step where the tracker saw it.
struct DropletEvent {
  enum class Kind { appeared, vanished, merged, split } kind;
  std::uint64_t step;
  std::vector<std::uint32_t> from;  ///< ids before
  std::vector<std::uint32_t> to;    ///< ids after
};

/// What can be asked of `Simulation::observe()` besides the cheap part.
struct ObserveRequest {
  bool beads = false;                   ///< copy positions, ids and droplet of every moving bead
  bool hash = false;                    ///< hash the complete state
  bool virial = false;                  ///< stress of the conservative forces; with `beads` also bead by bead
  bool wetted = false;                  ///< which cells of the plate liquid covers
  std::optional<StressSlabs> stress{};  ///< stress, density and velocity slab by slab
};

/// The state of a run between two steps, as plain values that no later step changes. Reduced units.
struct Snapshot {
  std::uint64_t step = 0;
  double time = 0;         ///< tau
  double temperature = 0;  ///< k_BT from the kinetic energy of the moving beads; 0 when there is none
  Vector3d momentum = Vector3d::Zero();
  std::size_t moving_beads = 0;
  std::size_t wall_beads = 0;
  std::size_t vapour_beads = 0;                          ///< moving beads that belong to no droplet
  std::vector<DropletObservation> droplets;              ///< by id
  std::vector<MicroparticleObservation> microparticles;  ///< by id
  std::vector<ChainObservation> chains;                  ///< by id
  std::vector<MembraneObservation> membranes;            ///< by id
  std::optional<std::uint64_t> state_hash;               ///< when asked for
  std::optional<Eigen::Matrix3d>
      virial;  ///< sum over liquid pairs and bonds of r_ij (x) F_ij, k_BT, when asked for
  std::optional<WettedArea> wetted;  ///< of the plate, when asked for and there is one
  std::vector<SlabStress> stress;    ///< lowest slab first; empty unless asked for
  // When beads are asked for, equally long, ordered by bead id:
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> velocities;
  std::vector<std::uint32_t> bead_ids;
  std::vector<std::uint32_t> bead_droplets;  ///< droplet id, 0 for vapour
  std::vector<std::uint8_t> bead_species;    ///< number of the liquid; empty while all are the first one
  std::vector<float> bead_virials;  ///< a third of the trace of each bead's share; empty unless asked for
};

}  // namespace dmf::engine
