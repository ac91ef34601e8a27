#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "chip/scene.h"
#include "tools/flow_field.h"

namespace dmf::tools {

/// The quasi-stationary method (Li et al.; Lan 2.4.2): the wettability gradient moves at the pace of the
/// microparticle, so that it and its droplet stay at one place of the gradient for as long as one measures.
///
/// The scene gives droplet, microparticle and gradient (the last set_wettability of its schedule). The
/// droplet picks the microparticle up as in the scene; then the gradient is slid under both until the
/// microparticle is at `place`, and held there. In a scene without microparticles the droplet's centroid
/// takes the part of the microparticle.
struct QuasiStationaryRun {
  double place = 0;       ///< x of the gradient that the microparticle is held at, r_c
  double slide = 0.05;    ///< how fast the gradient is slid there, r_c / tau
  double pickup = 2000;   ///< tau that the pickup may take, from the end of settle_time
  double ahead = 0.5;     ///< it is over when the droplet's centroid is so many droplet radii ahead
  double settle = 300;    ///< tau at the place before measuring
  double measure = 2000;  ///< tau
  bool flow = false;      ///< look at the flow too
  /// Steps between two looks at the flow: beads forget their thermal velocity, which hides it, in some 0.1
  /// tau.
  std::uint64_t flow_every = 10;
  std::string folder, key;  ///< where the run keeps its state while it is under way (SavedRun)
  double save_every = 60;   ///< s of wall time
  /// Called after each look with the time, before the state is saved: what it throws ends the run as a kill
  /// would.
  std::function<void(double)> after_look;
};

/// Means over the measurement, reduced units; NaN when the droplet has lost the microparticle.
struct QuasiStationary {
  double velocity = 0;  ///< of the microparticle over the wall
  double drive_x = 0, friction_x = 0;
  double drive_z = 0, normal_force = 0;
  double contact_fraction = 0, height = 0;
  double droplet_ahead = 0;  ///< x of the droplet's centroid from the microparticle
  FlowField flow;
  double earlier_computing = 0;  ///< SavedRun, s
};

/// Single-threaded. @throws engine::InvalidInput, engine::Instability; std::runtime_error when a file can't
/// be written.
QuasiStationary run_quasi_stationary(const chip::Scene& scene, std::uint64_t seed,
                                     const QuasiStationaryRun& run);

}  // namespace dmf::tools
