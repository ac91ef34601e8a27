#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chip/command.h"
#include "controller/layout.h"

namespace dmf::tools {

/// A protocol of config/protocols on a scene, and where its droplets are when it has worked.
struct ProtocolTrial {
  std::string name;
  std::string protocol;                       ///< in config/protocols
  std::string scene;                          ///< in config/scenes
  std::vector<controller::Channel> droplets;  ///< at the end, one a droplet, rising
  std::vector<chip::InjectFault> faults{};    ///< from the start
  double limit = 120;                         ///< s of the controller's clock
  /// Where the droplet is that carries all microparticles; none: the scene has no microparticle.
  std::optional<controller::Channel> microparticles{};
};

/// The shipped protocols, and a walk over an electrode with each fault that it can survive.
/// @param coarse  on scenes of coarse electrodes, for tests in a hurry.
std::vector<ProtocolTrial> protocol_trials(bool coarse);

/// What became of a trial. `worked` and all that stands below it is judged by where liquid and microparticles
/// are in the simulation: the controller is not asked.
struct TrialResult {
  bool claimed = false;                             ///< the controller says that it is done
  std::size_t steps_done = 0;                       ///< of the protocol
  double clock = 0;                                 ///< s of the controller's clock
  std::string text;                                 ///< what the controller says at the end
  bool worked = false;                              ///< claimed, and all is where the trial wants it
  std::vector<controller::Channel> droplets;        ///< the electrode nearest to each, rising
  std::vector<controller::Channel> microparticles;  ///< the electrode nearest to the droplet of each, rising
};

/// Runs a trial on one thread.
/// @throws InvalidInput when scene and protocol do not fit, engine::Instability.
TrialResult run_trial(const ProtocolTrial& trial, std::uint64_t seed);

/// "step 2 (merge): ...; droplets on 3, 5, wanted 4".
std::string describe(const ProtocolTrial& trial, const TrialResult& result);

}  // namespace dmf::tools
