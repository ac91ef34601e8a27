#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "chip/command.h"
#include "chip/experiment.h"
#include "chip/hash_chain.h"
#include "engine/observe/snapshot.h"

namespace dmf::node {

/// What keeps the run from being faster.
enum class Limit { engine, max_steps_per_second, paused, fault };

/// How the automatic checkpoints fare.
struct CheckpointStatus {
  bool wanted = false;
  std::string name;            ///< of the last one that was written; empty before the first
  std::uint64_t step = 0;      ///< of that one
  double age = 0;              ///< since it was written, s of wall time
  std::string problem;         ///< why the last attempt failed; empty: it did not
  std::uint32_t left_out = 0;  ///< since then, for the one before was still being written
};

/// Everything that the publisher needs to know of one moment between two steps. Immutable once made, so that
/// the engine can go on while it is being serialised. Reduced units, as in the snapshot.
struct Frame {
  std::uint64_t stamp = 0;  ///< ROS time, ns
  std::uint32_t run = 0;    ///< how often the run was reset or restored
  std::uint64_t seed = 0;
  std::string kernel;
  int threads = 0;
  std::shared_ptr<const engine::Snapshot> snapshot;
  bool has_beads = false;  ///< the snapshot was taken with beads
  std::vector<chip::ElectrodeState> electrodes;
  chip::RailState rail;
  engine::BodyForces body_forces;
  std::vector<std::vector<std::uint32_t>> channels;  ///< under each droplet of the snapshot, in its order
  bool paused = false;
  std::string fault;  ///< empty while the run is sound
  CheckpointStatus checkpoints;
  double steps_per_second = 0;
  Limit limit = Limit::engine;
};

/// A command as the engine thread passes it on.
struct CommandNote {
  std::uint64_t stamp = 0;  ///< ROS time, ns
  std::uint32_t run = 0;
  std::uint32_t index = 0;  ///< place in the run's history
  double time = 0;          ///< tau
  chip::CommandRecord record;
};

/// A record of the run's state as the engine thread passes it on.
struct StateHashNote {
  std::uint64_t stamp = 0;  ///< ROS time, ns
  std::uint32_t run = 0;
  std::uint64_t seed = 0;
  chip::StateRecord record;
};

/// What the board senses at one step.
struct CapacitanceNote {
  std::uint64_t stamp = 0;  ///< ROS time, ns
  std::uint32_t run = 0;
  double time = 0;  ///< tau
  chip::CapacitanceReading reading;
};

/// Something that happened, to a droplet, to a microparticle, to the board or to the run.
struct EventNote {
  std::uint64_t stamp = 0;  ///< ROS time, ns
  std::uint32_t run = 0;
  std::uint64_t step = 0;
  double time = 0;                           ///< tau
  std::string kind;                          ///< one of the constants of Event.msg
  std::vector<std::uint32_t> before, after;  ///< droplet ids
  std::uint32_t microparticle = 0;           ///< id, 0: none
  std::string message;
};

}  // namespace dmf::node
