#pragma once
#include <string>
#include <vector>

#include "chip/command.h"
#include "chip/scene.h"
#include "engine/parameters.h"
#include "engine/simulation.h"
#include "engine/wettability.h"

namespace dmf::chip {

/// What is wrong with a command for this scene, whoever gives it: a service, the schedule or a pattern. Each
/// names the thing, its value and what is allowed. Empty when the command is sound; what depends on where the
/// liquid is by then (an occupied place, a droplet that is gone), and a microparticle's own ranges, only the
/// engine can tell.
std::vector<std::string> violations(const Command& command, const Scene& scene,
                                    const engine::ContactAngleCurve& curve);

/// Volume of a pancake whose footprint is `count` times the electrode nearest to a point (r_c), half the gaps
/// around it included, r_c^3. @throws engine::InvalidInput without a top plate or without electrodes.
double filling_volume(const Scene& scene, const Vector2d& point, double count);

/// The droplet that a DispenseDroplet asks for: a sphere just touching the plate, or a pancake, r_c.
/// @throws engine::InvalidInput as filling_volume.
engine::DropletPlacement placement_of(const DispenseDroplet& command, const Scene& scene);

/// The body that an AddMicroparticle asks for, reduced units.
/// @throws engine::InvalidInput when its contact angle is outside the scene's calibration.
engine::MicroparticlePlacement placement_of(const AddMicroparticle& command, const Scene& scene);

engine::BodyForces body_forces_of(const SetBodyForces& command, const Scene& scene);

/// What is wrong with where a droplet is to be placed; a side on which the domain is periodic bounds only its
/// centre.
std::vector<std::string> violations(const engine::DropletPlacement& placement, const Scene& scene);

}  // namespace dmf::chip
