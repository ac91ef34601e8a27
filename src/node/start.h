#pragma once
#include <memory>
#include <string>

#include "chip/checkpoint_series.h"
#include "chip/experiment.h"
#include "node/engine_thread.h"
#include "node/master_memory.h"
#include "node/options.h"

namespace dmf::node {

/// Names of automatic checkpoints begin so: auto.NODE.SCENE.NUMBER. Several chips share a folder that way.
constexpr const char* kAutomatic = "auto.";
bool is_automatic(const std::string& checkpoint);

/// The automatic checkpoints of a node's runs of a scene. @param node  "/chip".
chip::CheckpointSeries automatic_checkpoints(const Options& options, const std::string& node,
                                             const chip::Scene& scene);

/// On standard error, as everything that happens before and after topics are there.
void tell(const std::string& text);

/// How a node begins.
struct Start {
  std::unique_ptr<chip::Experiment> experiment;
  EngineSettings settings;
};

/// The run from the scene's start, or with ~resume from an automatic checkpoint of this scene and seed:
/// `true` takes the newest there is; `respawned` takes one only when this node was started before under the
/// same launch, and none that is older than that first start. ~respawn_from tells: the first start sets it, a
/// launch file that clears the parameters takes it away, a respawn does not. A node that comes back so is
/// paused or runs as it was.
///
/// ROS time and run number go on after those that the master knows of this node.
/// @throws engine::InvalidInput when the scene can't be run as asked, or another process writes the series.
Start begin(const Options& options, const chip::Scene& scene, chip::CheckpointSeries& series,
            const MasterMemory& memory);

}  // namespace dmf::node
