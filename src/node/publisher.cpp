#include "node/publisher.h"

#include <ros/console.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "node/markers.h"
#include "node/process_memory.h"

namespace dmf::node {

namespace {

constexpr auto kPatience = std::chrono::milliseconds(200);    // in which new subscribers are noticed
constexpr auto kDiagnosticsPeriod = std::chrono::seconds(1);  // what diagnostic tools expect
constexpr auto kChipMarkerPeriod = std::chrono::seconds(1);   // so that a bag can be entered anywhere
constexpr std::uint32_t kStateQueue = 10, kDisplayQueue = 2, kRecordQueue = 10000;

bool same(const dmf_sim::ElectrodeArray& a, const dmf_sim::ElectrodeArray& b) {
  return a.hv_voltage == b.hv_voltage && a.hv_frequency == b.hv_frequency && a.hv_enabled == b.hv_enabled &&
         a.electrodes == b.electrodes;
}

/// The ids that were drawn and are no longer among what is observed; `drawn` is brought up to date.
template <typename Observation>
std::set<std::uint32_t> take_gone(std::set<std::uint32_t>& drawn, const std::vector<Observation>& observed) {
  std::set<std::uint32_t> present, gone;
  for (const Observation& one : observed) present.insert(one.id);
  std::set_difference(drawn.begin(), drawn.end(), present.begin(), present.end(),
                      std::inserter(gone, gone.end()));
  drawn = std::move(present);
  return gone;
}

}  // namespace

Publisher::Publisher(ros::NodeHandle& handle, ros::NodeHandle& private_handle, EngineThread& engine,
                     const ConversionContext& context, MasterMemory& memory, std::uint32_t hash_interval)
    : engine_(engine),
      context_(context),
      memory_(memory),
      run_record_(private_handle, hash_interval > 0),
      clock_watch_(handle, [this](const std::string& other) { announce_clock(other); }) {
  clock_ = handle.advertise<rosgraph_msgs::Clock>("/clock", kStateQueue);
  diagnostics_ = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", kStateQueue);
  state_ = private_handle.advertise<dmf_sim::ChipState>("state", kStateQueue);
  electrodes_ = private_handle.advertise<dmf_sim::ElectrodeArray>("electrodes", kStateQueue, true);
  droplets_ = private_handle.advertise<dmf_sim::DropletArray>("droplets", kStateQueue);
  microparticles_ = private_handle.advertise<dmf_sim::MicroparticleArray>("microparticles", kStateQueue);
  capacitance_ = private_handle.advertise<dmf_sim::Capacitance>("capacitance", kStateQueue);
  particles_ = private_handle.advertise<sensor_msgs::PointCloud2>("particles", kDisplayQueue);
  markers_ = private_handle.advertise<visualization_msgs::MarkerArray>("markers", kDisplayQueue);
  commands_ = private_handle.advertise<dmf_sim::Command>(
      "commands", kRecordQueue,
      [this](const ros::SingleSubscriberPublisher& subscriber) { replay_commands(subscriber); });
  events_ = private_handle.advertise<dmf_sim::Event>("events", kRecordQueue);
  layout_ = private_handle.advertise<dmf_sim::Layout>("layout", 1, true);

  scene_ = private_handle.advertise<dmf_sim::Scene>("scene", 1, true);

  layout_.publish(to_layout(context_));
  scene_.publish(to_scene(*engine_.inspect(false), hash_interval, context_));
  static_transforms_.sendTransform(static_transforms(context_, to_ros_time(RunClock::kStart)));
  thread_ = std::thread([this] { loop(); });
}

Publisher::~Publisher() { stop(); }

void Publisher::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void Publisher::loop() {
  Outbox::Delivery delivery;
  bool last = false;
  while (!last) {
    last = stopping_;  // read before the outbox, so that what the engine left in it last is published too
    engine_.want_beads(particles_.getNumSubscribers() + markers_.getNumSubscribers() > 0);
    engine_.want_capacitance(capacitance_.getNumSubscribers());
    if (engine_.outbox().take(delivery, kPatience)) publish(delivery);
  }
}

void Publisher::publish(const Outbox::Delivery& delivery) {
  if (delivery.frame) memory_.before_run(delivery.frame->run);
  for (const CommandNote& command : delivery.commands) memory_.before_run(command.run);
  // The clock first: what follows then never lies in its subscribers' future.
  if (delivery.clock > 0) publish_clock(delivery.clock);
  if (delivery.lost > 0)
    ROS_ERROR("%zu commands and events were lost: nothing took them",
              static_cast<std::size_t>(delivery.lost));
  for (const CommandNote& command : delivery.commands) publish_command(command);
  for (const StateHashNote& hash : delivery.hashes) run_record_.publish(to_run_record(hash, context_));
  for (const EventNote& event : delivery.events) events_.publish(to_event(event, context_));
  if (delivery.frame) publish_frame(*delivery.frame);
  if (delivery.capacitance) capacitance_.publish(to_capacitance(*delivery.capacitance, context_));
}

void Publisher::publish_clock(std::uint64_t nanoseconds) {
  memory_.before_clock(nanoseconds);
  rosgraph_msgs::Clock message;
  message.clock = to_ros_time(nanoseconds);
  clock_.publish(message);
}

void Publisher::publish_command(const CommandNote& note) {
  const dmf_sim::Command message = to_command(note, context_);
  run_record_.add(message);
  const std::lock_guard lock(history_mutex_);
  if (!history_.empty() && history_.back().run != message.run) history_.clear();
  history_.push_back(message);
  commands_.publish(message);
}

void Publisher::replay_commands(const ros::SingleSubscriberPublisher& subscriber) {
  const std::lock_guard lock(history_mutex_);
  for (const dmf_sim::Command& command : history_) subscriber.publish(command);
}

void Publisher::announce_clock(const std::string& other) {
  try {
    engine_.announce(dmf_sim::Event::CLOCK_CONFLICT, clock_conflict({other}));
  } catch (const EngineStopped&) {
    // Nobody is left to be told.
  }
}

void Publisher::publish_frame(const Frame& frame) {
  state_.publish(to_state(frame, context_));
  publish_electrodes(frame);
  droplets_.publish(to_droplets(frame, context_));
  microparticles_.publish(to_microparticles(frame, context_));
  publish_transforms(frame);
  if (frame.has_beads) {
    if (particles_.getNumSubscribers() > 0) particles_.publish(to_particles(frame, context_));
    publish_markers(frame);
  }
  publish_diagnostics(frame);
}

void Publisher::publish_electrodes(const Frame& frame) {
  dmf_sim::ElectrodeArray message = to_electrodes(frame);
  if (electrodes_published_ && same(message, last_electrodes_)) return;
  electrodes_.publish(message);
  last_electrodes_ = std::move(message);
  electrodes_published_ = true;
  chip_changed_ = true;
}

void Publisher::publish_transforms(const Frame& frame) {
  // tf warns about every transform that it gets twice with one stamp, as a paused chip would send it.
  if (frame.stamp == transform_stamp_) return;
  transform_stamp_ = frame.stamp;
  transforms_.sendTransform(droplet_transforms(frame, context_));
  transforms_.sendTransform(microparticle_transforms(frame, context_));
}

void Publisher::publish_markers(const Frame& frame) {
  const std::uint32_t subscribers = markers_.getNumSubscribers();
  const bool joined = subscribers > marker_subscribers_;
  marker_subscribers_ = subscribers;
  if (subscribers == 0) return;
  visualization_msgs::MarkerArray array = droplet_markers(frame, context_);
  const auto add = [&array](visualization_msgs::MarkerArray more) {
    std::move(more.markers.begin(), more.markers.end(), std::back_inserter(array.markers));
  };

  add(microparticle_markers(frame, context_));
  add(deletions(take_gone(drawn_droplets_, frame.snapshot->droplets),
                take_gone(drawn_microparticles_, frame.snapshot->microparticles), to_ros_time(frame.stamp)));

  const bool has_chains = !frame.snapshot->chains.empty();
  add(bond_markers(frame, context_));
  add(bond_deletions(drawn_chains_ && !has_chains, take_gone(drawn_membranes_, frame.snapshot->membranes),
                     to_ros_time(frame.stamp)));
  drawn_chains_ = has_chains;

  if (joined || chip_changed_ || Clock::now() >= next_chip_markers_) {
    add(chip_markers(frame, context_));
    chip_changed_ = false;
    next_chip_markers_ = Clock::now() + kChipMarkerPeriod;
  }
  markers_.publish(array);
}

void Publisher::publish_diagnostics(const Frame& frame) {
  if (Clock::now() < next_diagnostics_) return;
  next_diagnostics_ = Clock::now() + kDiagnosticsPeriod;
  diagnostic_msgs::DiagnosticArray report = to_diagnostics(frame, context_);
  report.status.push_back(clock_status(clock_watch_.others(), context_));
  report.status.push_back(memory_status(memory_use(), context_));
  diagnostics_.publish(report);
}

}  // namespace dmf::node
