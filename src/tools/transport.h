#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "chip/scene.h"

namespace dmf::tools {

/// A look at one microparticle on its way, and at the droplet. Reduced units; means and events are those
/// since the look before. In a scene without microparticles one record a look, with the droplet's part alone.
/// A double each, so that a record is a line of a CSV file; NaN where there is nothing to tell.
struct TransportRecord {
  double microparticle = 0;  ///< id; 0: the scene has none
  double time = 0;           ///< tau after the end of settle_time, negative before
  double x = 0, y = 0, z = 0;
  double height = 0;                      ///< of the centre over the wall plane, mean
  double contact_fraction = 0;            ///< with the wall, mean
  double normal_force = 0;                ///< of the wall, mean, k_BT / r_c
  double drive_x = 0, drive_z = 0;        ///< force of the liquid, mean
  double friction_x = 0;                  ///< force of the wall in its plane, mean
  double immersion = 0;                   ///< 0 dry to about 1 engulfed
  double place = 0;                       ///< engine::MicroparticlePlace: 0 dry, 1 front, 2 rear, 3 inside
  double carrier = 0;                     ///< id of the droplet that carries it, 0: none
  double picked_up = 0, dropped_off = 0;  ///< how often
  double droplets = 0;                    ///< how many there are
  double droplet = 0;                     ///< id of the largest
  double droplet_x = 0, droplet_y = 0, droplet_z = 0;  ///< centroid of the largest
};

/// When a run ends, and what it leaves where.
struct TransportRun {
  double limit = 1000;  ///< tau after the end of settle_time
  /// Ends when every microparticle (in a scene without, the largest droplet) has come as far as this x, r_c.
  double goal = std::numeric_limits<double>::infinity();
  /// Ends so many tau after nothing is carried any more that once was.
  double after_drop_off = std::numeric_limits<double>::infinity();
  /// Ends when the droplet is so far ahead of every microparticle and has picked none up: a droplet wanders
  /// sideways by some r_c on a repellent wall, and may pass by.
  double missed = 15;       ///< r_c
  double record_every = 5;  ///< tau
  std::string folder;       ///< of the files below
  std::string key;          ///< names them
  double save_every = 60;   ///< s of wall time: what a kill can cost
  /// Called after each look, before it is saved: what it throws ends the run as a kill would.
  std::function<void(const TransportRecord&)> after_record;
};

/// What a run has left.
struct Transport {
  std::vector<TransportRecord> records;     ///< by time, then by id
  std::optional<std::uint64_t> state_hash;  ///< of the end; absent when the run was read from its file
  double earlier_computing = NAN;           ///< SavedRun; NaN when the run was read from its file
};

/// Runs a scene with microparticles on one thread. Leaves `folder`/KEY.csv, a line a record; while it is
/// under way that is KEY.part.csv, with KEY.state beside it, from which the next call goes on with the same
/// bits. A run that is there already is read, not run.
/// @throws engine::InvalidInput, engine::Instability; std::runtime_error when a file can't be written.
Transport run_transport(const chip::Scene& scene, std::uint64_t seed, const TransportRun& run);

/// @throws std::runtime_error when the file is none of run_transport().
std::vector<TransportRecord> read_records(const std::string& file);

}  // namespace dmf::tools
