#pragma once
#include <diagnostic_msgs/DiagnosticArray.h>
#include <dmf_sim/AddMicroparticle.h>
#include <dmf_sim/Capacitance.h>
#include <dmf_sim/CheckpointFile.h>
#include <dmf_sim/ChipState.h>
#include <dmf_sim/Command.h>
#include <dmf_sim/DropletArray.h>
#include <dmf_sim/ElectrodeArray.h>
#include <dmf_sim/Event.h>
#include <dmf_sim/ExplainDroplet.h>
#include <dmf_sim/Layout.h>
#include <dmf_sim/MicroparticleArray.h>
#include <dmf_sim/RunRecord.h>
#include <dmf_sim/Scene.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "chip/scene.h"
#include "node/frame.h"
#include "node/process_memory.h"

/// Between the chip's plain values and ROS messages: pure functions, no node needed. SI units, except in
/// fields that end in _mdpd; what is only looked at (particles, transforms, markers) is scaled up by the
/// display scale.
namespace dmf::node {

/// What the conversions need to know besides a frame. Constant during a run.
struct ConversionContext {
  const chip::Scene& scene;
  double display_scale;              ///< metres on the screen per metre on the chip, > 0
  double ros_seconds_per_time_unit;  ///< ROS seconds per tau, > 0
  std::uint64_t session = 0;         ///< ns of wall time at which the node began

  /// Metres on the screen per r_c.
  double display_length() const { return display_scale * scene.units.length_m; }
  /// z of the wetting plate, r_c.
  double plate_z() const { return scene.parameters.domain.lower.z(); }
};

/// With it the diagonal of the scene's domain is 0.45 to 0.9 m on the screen, what RViz shows from 1 m away,
/// so that every chip fits as it opens. One digit and zeros, 1 to 10^6.
double fitting_display_scale(const chip::Scene& scene);

constexpr const char* kChipFrame = "chip";
constexpr const char* kMiddleFrame = "chip/middle";
std::string electrode_frame(std::uint32_t channel);  ///< chip/electrode_<channel>
std::string droplet_frame(std::uint32_t id);         ///< chip/droplet_<id>
std::string microparticle_frame(std::uint32_t id);   ///< chip/microparticle_<id>

ros::Time to_ros_time(std::uint64_t nanoseconds);
/// 16 hex digits, as dmf_run prints it.
std::string hash_text(std::uint64_t hash);

dmf_sim::ChipState to_state(const Frame& frame, const ConversionContext& context);
dmf_sim::ElectrodeArray to_electrodes(const Frame& frame);
dmf_sim::DropletArray to_droplets(const Frame& frame, const ConversionContext& context);
dmf_sim::MicroparticleArray to_microparticles(const Frame& frame, const ConversionContext& context);
dmf_sim::Layout to_layout(const ConversionContext& context);
dmf_sim::Command to_command(const CommandNote& command, const ConversionContext& context);
dmf_sim::Capacitance to_capacitance(const CapacitanceNote& note, const ConversionContext& context);
/// Without success and message.
dmf_sim::ExplainDroplet::Response to_response(const chip::DropletExplanation& explanation,
                                              const ConversionContext& context);
dmf_sim::Event to_event(const EventNote& event, const ConversionContext& context);
/// What a run begins from. @param frame  any of the run.
dmf_sim::Scene to_scene(const Frame& frame, std::uint32_t hash_interval, const ConversionContext& context);
/// One hash, without commands.
dmf_sim::RunRecord to_run_record(const StateHashNote& note, const ConversionContext& context);

std::array<double, 3> to_array(const geometry_msgs::Vector3& vector);
/// What is 0 and can't be, or says nothing, is left to its default.
chip::AddMicroparticle to_command(const dmf_sim::AddMicroparticle::Request& request);

/// Fields x, y, z (m on the screen, float32), id, droplet (uint32, droplet 0 is vapour), speed (m/s on the
/// chip, float32). @pre frame.has_beads.
sensor_msgs::PointCloud2 to_particles(const Frame& frame, const ConversionContext& context);

/// chip -> chip/droplet_<id> at each centroid, unrotated, scaled.
std::vector<geometry_msgs::TransformStamped> droplet_transforms(const Frame& frame,
                                                                const ConversionContext& context);
/// chip -> chip/microparticle_<id> at each centre of mass, turned as the body is, scaled.
std::vector<geometry_msgs::TransformStamped> microparticle_transforms(const Frame& frame,
                                                                      const ConversionContext& context);
/// What stays where it is, unrotated, scaled: chip -> chip/electrode_<n> at each centroid on the plate, and
/// chip/middle at the middle of the domain.
std::vector<geometry_msgs::TransformStamped> static_transforms(const ConversionContext& context,
                                                               ros::Time stamp);

/// The engine's health (ERROR after a fault, WARN when the temperature is more than a tenth off) and the
/// rail (ERROR while it is halted).
diagnostic_msgs::DiagnosticArray to_diagnostics(const Frame& frame, const ConversionContext& context);
/// What is wrong when these nodes publish /clock too.
std::string clock_conflict(const std::vector<std::string>& others);
/// ERROR while there are any.
diagnostic_msgs::DiagnosticStatus clock_status(const std::vector<std::string>& others,
                                               const ConversionContext& context);
/// What the node takes, for whoever leaves it running for days; always OK.
diagnostic_msgs::DiagnosticStatus memory_status(const MemoryUse& memory, const ConversionContext& context);

}  // namespace dmf::node
