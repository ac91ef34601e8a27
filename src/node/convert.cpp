#include "node/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "node/convert_values.h"

namespace dmf::node {

namespace {

const char* place_name(engine::MicroparticlePlace place) {
  using dmf_sim::Microparticle;
  switch (place) {
    case engine::MicroparticlePlace::dry:
      return Microparticle::DRY.c_str();
    case engine::MicroparticlePlace::front:
      return Microparticle::FRONT.c_str();
    case engine::MicroparticlePlace::rear:
      return Microparticle::REAR.c_str();
    case engine::MicroparticlePlace::inside:
      return Microparticle::INSIDE.c_str();
  }
  return "";
}

geometry_msgs::TransformStamped to_transform(const std::string& child, const Vector3d& position,
                                             ros::Time stamp) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = kChipFrame;
  transform.child_frame_id = child;
  transform.transform.translation = to_vector(position);
  transform.transform.rotation.w = 1;
  return transform;
}

dmf_sim::Droplet to_droplet(const engine::DropletObservation& droplet,
                            const std::vector<std::uint32_t>& channels, const ConversionContext& context) {
  const engine::Units& units = context.scene.units;
  dmf_sim::Droplet message;
  message.id = droplet.id;
  message.parents = droplet.parents;
  message.species = liquid_name(context.scene.parameters, droplet.species);
  message.beads = static_cast<std::uint32_t>(droplet.beads);
  message.centroid = to_point(droplet.centroid * units.length_m);
  message.velocity = to_vector(droplet.velocity * units.velocity_m_per_s());
  message.centroid_mdpd = to_point(droplet.centroid);
  message.velocity_mdpd = to_vector(droplet.velocity);
  message.lower = to_point(droplet.lower * units.length_m);
  message.upper = to_point(droplet.upper * units.length_m);
  message.volume = droplet.volume * units.volume_m3();
  message.height = droplet.height * units.length_m;
  message.footprint_area = droplet.footprint_area * units.area_m2();
  for (const auto& corner : droplet.footprint) {
    message.footprint.push_back(
        to_point(Vector3d(corner.x(), corner.y(), context.plate_z()) * units.length_m));
  }
  message.contact_angle_deg = or_nan(droplet.contact_angle);
  message.advancing_angle_deg = or_nan(droplet.advancing_angle);
  message.receding_angle_deg = or_nan(droplet.receding_angle);
  message.channels = channels;
  return message;
}

dmf_sim::Microparticle to_microparticle(const engine::MicroparticleObservation& body,
                                        const engine::Units& units) {
  constexpr double kTouching = 0.5;  // of the steps: more than that is contact
  dmf_sim::Microparticle message;
  message.id = body.id;
  message.radius = body.radius * units.length_m;
  message.mass = body.mass * units.mass_kg;
  message.beads = body.beads;
  message.magnetic = body.magnetic;
  message.attraction_mdpd = body.attraction;
  message.pose.position = to_point(body.position * units.length_m);
  message.pose.orientation = to_quaternion(body.orientation);
  message.twist.linear = to_vector(body.velocity * units.velocity_m_per_s());
  message.twist.angular = to_vector(body.angular_velocity / units.time_s);
  message.position_mdpd = to_point(body.position);
  message.velocity_mdpd = to_vector(body.velocity);
  message.angular_velocity_mdpd = to_vector(body.angular_velocity);
  message.contact = body.contact_fraction > kTouching;
  message.contact_fraction = body.contact_fraction;
  message.contact_normal.z = message.contact ? 1 : 0;  // it stands on what is below it
  message.normal_force = body.normal_force * units.force_N();
  message.friction_force = to_vector(body.friction_force * units.force_N());
  message.drive_force = to_vector(body.drive_force * units.force_N());
  message.immersion = body.immersion;
  message.droplet = body.droplet;
  message.place = place_name(body.place);
  return message;
}

}  // namespace

double fitting_display_scale(const chip::Scene& scene) {
  constexpr double view = 0.9;  // m across, of config/rviz/chip.rviz
  const double largest = view / (scene.parameters.domain.size().norm() * scene.units.length_m);
  const double digit = std::pow(10, std::floor(std::log10(largest)));
  return std::clamp(std::floor(largest / digit) * digit, 1.0, 1e6);
}

std::string electrode_frame(std::uint32_t channel) { return fmt::format("chip/electrode_{}", channel); }
std::string droplet_frame(std::uint32_t id) { return fmt::format("chip/droplet_{}", id); }
std::string microparticle_frame(std::uint32_t id) { return fmt::format("chip/microparticle_{}", id); }

ros::Time to_ros_time(std::uint64_t nanoseconds) { return ros::Time().fromNSec(nanoseconds); }

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

dmf_sim::ChipState to_state(const Frame& frame, const ConversionContext& context) {
  const engine::Snapshot& snapshot = *frame.snapshot;
  dmf_sim::ChipState state;
  state.header.stamp = to_ros_time(frame.stamp);
  state.header.frame_id = kChipFrame;
  state.scene = context.scene.name;
  state.seed = frame.seed;
  state.kernel = frame.kernel;
  state.threads = static_cast<std::uint32_t>(frame.threads);
  state.run = frame.run;
  state.step = snapshot.step;
  state.time = snapshot.time * context.scene.units.time_s;
  state.time_mdpd = snapshot.time;
  state.paused = frame.paused;
  state.fault = frame.fault;
  state.steps_per_second = frame.steps_per_second;
  state.limited_by = limit_name(frame.limit);
  state.hv_voltage = frame.rail.voltage;
  state.hv_frequency = frame.rail.frequency;
  state.hv_enabled = frame.rail.enabled;
  state.halted = frame.rail.halted;
  state.temperature_mdpd = snapshot.temperature;
  state.target_temperature_mdpd = context.scene.parameters.liquid.temperature;
  state.momentum_mdpd = to_vector(snapshot.momentum);
  state.moving_beads = snapshot.moving_beads;
  state.wall_beads = snapshot.wall_beads;
  state.vapour_beads = snapshot.vapour_beads;
  state.droplets = static_cast<std::uint32_t>(snapshot.droplets.size());
  state.microparticles = static_cast<std::uint32_t>(snapshot.microparticles.size());
  const engine::Units& units = context.scene.units;
  state.gravity = to_vector(frame.body_forces.gravity * units.acceleration_m_per_s2());
  state.magnetic = to_vector(frame.body_forces.magnetic * units.force_N());
  if (snapshot.state_hash) state.state_hash = hash_text(*snapshot.state_hash);
  return state;
}

dmf_sim::DropletArray to_droplets(const Frame& frame, const ConversionContext& context) {
  const engine::Snapshot& snapshot = *frame.snapshot;
  dmf_sim::DropletArray message;
  message.header.stamp = to_ros_time(frame.stamp);
  message.header.frame_id = kChipFrame;
  message.step = snapshot.step;
  message.time = snapshot.time * context.scene.units.time_s;
  message.droplets.reserve(snapshot.droplets.size());
  for (std::size_t i = 0; i < snapshot.droplets.size(); ++i) {
    message.droplets.push_back(to_droplet(snapshot.droplets[i], frame.channels.at(i), context));
  }
  return message;
}

dmf_sim::MicroparticleArray to_microparticles(const Frame& frame, const ConversionContext& context) {
  const engine::Snapshot& snapshot = *frame.snapshot;
  dmf_sim::MicroparticleArray message;
  message.header.stamp = to_ros_time(frame.stamp);
  message.header.frame_id = kChipFrame;
  message.step = snapshot.step;
  message.time = snapshot.time * context.scene.units.time_s;
  for (const auto& body : snapshot.microparticles) {
    message.microparticles.push_back(to_microparticle(body, context.scene.units));
  }
  return message;
}

dmf_sim::Command to_command(const CommandNote& command, const ConversionContext& context) {
  dmf_sim::Command message;
  message.header.stamp = to_ros_time(command.stamp);
  message.header.frame_id = kChipFrame;
  message.session = context.session;
  message.run = command.run;
  message.index = command.index;
  message.step = command.record.step;
  message.time = command.time * context.scene.units.time_s;
  message.name = chip::name_of(command.record.command);
  message.json = chip::to_json(command.record.command);
  return message;
}

dmf_sim::Event to_event(const EventNote& event, const ConversionContext& context) {
  dmf_sim::Event message;
  message.header.stamp = to_ros_time(event.stamp);
  message.header.frame_id = kChipFrame;
  message.run = event.run;
  message.step = event.step;
  message.time = event.time * context.scene.units.time_s;
  message.kind = event.kind;
  message.before = event.before;
  message.after = event.after;
  message.microparticle = event.microparticle;
  message.message = event.message;
  return message;
}

dmf_sim::Scene to_scene(const Frame& frame, std::uint32_t hash_interval, const ConversionContext& context) {
  dmf_sim::Scene message;
  message.header.stamp = to_ros_time(frame.stamp);
  message.header.frame_id = kChipFrame;
  message.session = context.session;
  message.name = context.scene.name;
  message.version = DMF_SIM_VERSION;
  message.seed = frame.seed;
  message.kernel = frame.kernel;
  message.hash_interval = hash_interval;
  message.fingerprint = hash_text(chip::fingerprint(context.scene.files));
  for (const chip::SceneFile& file : context.scene.files.all()) {
    dmf_sim::SceneFile& copy = message.files.emplace_back();
    copy.role = file.role;
    copy.path = file.path;
    copy.text = file.text;
  }
  return message;
}

dmf_sim::RunRecord to_run_record(const StateHashNote& note, const ConversionContext& context) {
  dmf_sim::RunRecord message;
  message.header.stamp = to_ros_time(note.stamp);
  message.header.frame_id = kChipFrame;
  message.session = context.session;
  message.run = note.run;
  message.seed = note.seed;
  dmf_sim::StateHash& hash = message.hashes.emplace_back();
  hash.index = note.record.index;
  hash.step = note.record.step;
  hash.commands = note.record.commands;
  hash.hash = hash_text(note.record.hash);
  hash.chain = hash_text(note.record.chain);
  return message;
}

std::array<double, 3> to_array(const geometry_msgs::Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

chip::AddMicroparticle to_command(const dmf_sim::AddMicroparticle::Request& request) {
  chip::AddMicroparticle command;
  command.x = request.x;
  command.y = request.y;
  command.height = request.height;
  command.radius = request.radius;
  command.beads = request.beads;
  command.smooth = request.smooth != 0;
  for (const auto& point : request.points) command.points.emplace_back(point.x, point.y, point.z);
  if (request.mass != 0) command.mass = request.mass;
  if (request.contact_angle_deg != 0) command.contact_angle_deg = request.contact_angle_deg;
  if (request.attraction_mdpd != 0) command.attraction = request.attraction_mdpd;
  command.static_friction = request.static_friction;
  command.kinetic_friction = request.kinetic_friction;
  command.rolling_friction = request.rolling_friction;
  command.magnetic = request.magnetic != 0;
  return command;
}

sensor_msgs::PointCloud2 to_particles(const Frame& frame, const ConversionContext& context) {
  // One record of the cloud, as its fields below describe it.
  struct Record {
    float x, y, z;
    std::uint32_t id, droplet;
    float speed;
  };
  static_assert(sizeof(Record) == 24);

  const engine::Snapshot& snapshot = *frame.snapshot;
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = to_ros_time(frame.stamp);
  cloud.header.frame_id = kChipFrame;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(snapshot.positions.size());
  cloud.is_bigendian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  cloud.is_dense = true;
  // In a mixture another word a record says which liquid.
  const bool mixed = !snapshot.bead_species.empty();
  cloud.point_step = sizeof(Record) + (mixed ? sizeof(std::uint32_t) : 0);
  cloud.row_step = cloud.point_step * cloud.width;
  const auto add_field = [&cloud](const char* name, std::size_t offset, std::uint8_t type) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(offset);
    field.datatype = type;
    field.count = 1;
    cloud.fields.push_back(field);
  };
  add_field("x", offsetof(Record, x), sensor_msgs::PointField::FLOAT32);
  add_field("y", offsetof(Record, y), sensor_msgs::PointField::FLOAT32);
  add_field("z", offsetof(Record, z), sensor_msgs::PointField::FLOAT32);
  add_field("id", offsetof(Record, id), sensor_msgs::PointField::UINT32);
  add_field("droplet", offsetof(Record, droplet), sensor_msgs::PointField::UINT32);
  add_field("speed", offsetof(Record, speed), sensor_msgs::PointField::FLOAT32);

  if (mixed) add_field("species", sizeof(Record), sensor_msgs::PointField::UINT32);

  const auto length = static_cast<float>(context.display_length());
  const auto velocity = static_cast<float>(context.scene.units.velocity_m_per_s());
  cloud.data.resize(cloud.row_step);
  for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
    const Eigen::Vector3f p = snapshot.positions[i] * length;
    const Record record{p.x(),
                        p.y(),
                        p.z(),
                        snapshot.bead_ids[i],
                        snapshot.bead_droplets[i],
                        snapshot.velocities[i].norm() * velocity};
    std::uint8_t* const to = cloud.data.data() + i * cloud.point_step;
    std::memcpy(to, &record, sizeof(Record));
    if (!mixed) continue;
    const std::uint32_t species = snapshot.bead_species[i];
    std::memcpy(to + sizeof(Record), &species, sizeof species);
  }
  return cloud;
}

std::vector<geometry_msgs::TransformStamped> droplet_transforms(const Frame& frame,
                                                                const ConversionContext& context) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const auto& droplet : frame.snapshot->droplets) {
    transforms.push_back(to_transform(droplet_frame(droplet.id), droplet.centroid * context.display_length(),
                                      to_ros_time(frame.stamp)));
  }
  return transforms;
}

std::vector<geometry_msgs::TransformStamped> microparticle_transforms(const Frame& frame,
                                                                      const ConversionContext& context) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const auto& body : frame.snapshot->microparticles) {
    transforms.push_back(to_transform(microparticle_frame(body.id), body.position * context.display_length(),
                                      to_ros_time(frame.stamp)));
    transforms.back().transform.rotation = to_quaternion(body.orientation);
  }
  return transforms;
}

std::vector<geometry_msgs::TransformStamped> static_transforms(const ConversionContext& context,
                                                               ros::Time stamp) {
  const engine::Domain& domain = context.scene.parameters.domain;
  const Vector3d middle = 0.5 * (domain.lower + domain.upper);
  std::vector<geometry_msgs::TransformStamped> transforms = {
      to_transform(kMiddleFrame, middle * context.display_length(), stamp)};
  for (const chip::Electrode& electrode : context.scene.layout.electrodes()) {
    const Vector3d position(electrode.centroid.x(), electrode.centroid.y(), context.plate_z());
    transforms.push_back(
        to_transform(electrode_frame(electrode.channel), position * context.display_length(), stamp));
  }
  return transforms;
}

}  // namespace dmf::node
