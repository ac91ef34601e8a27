#include "tools/headless_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "chip/checkpoint_file.h"
#include "tools/progress.h"

namespace dmf::tools {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool> interrupted{false};
extern "C" void on_interrupt(int) { interrupted = true; }

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A table in a file that is there once it has a line. Without a folder it keeps nothing.
class Table {
 public:
  Table(const std::string& folder, const char* name, bool append, const char* head)
      : file_(folder.empty() ? "" : folder + "/" + name), append_(append), head_(head) {}

  bool wanted() const { return !file_.empty(); }

  void add(const std::string& line) {
    if (!wanted()) return;
    if (!out_.is_open()) open();
    out_ << line << '\n';
  }

  void flush() {
    if (!out_.is_open()) return;
    out_.flush();
    if (!out_) throw std::runtime_error(fmt::format("{}: write failed; is the disk full?", file_));
  }

 private:
  void open() {
    const bool fresh = !append_ || !std::filesystem::exists(file_);
    out_.open(file_, fresh ? std::ios::trunc : std::ios::app);
    if (!out_) throw std::runtime_error(fmt::format("{}: can't be written", file_));
    if (fresh) out_ << head_ << '\n';
  }

  std::string file_;
  bool append_;
  const char* head_;
  std::ofstream out_;
};

/// One line a look and droplet, and a look and microparticle; droplets in SI units beside reduced ones.
class Log {
 public:
  Log(const std::string& folder, bool append)
      : droplets_(
            folder, "droplets.csv", append,
            "step,time_mdpd,time_s,droplet,beads,x_mdpd,y_mdpd,z_mdpd,vx_mdpd,vy_mdpd,vx_mm_per_s,vy_mm_"
            "per_s,footprint_area_mdpd,height_mdpd,advancing_deg,receding_deg,temperature"),
        microparticles_(
            folder, "microparticles.csv", append,
            "step,time_mdpd,time_s,microparticle,x_mdpd,y_mdpd,z_mdpd,vx_mdpd,vy_mdpd,vz_mdpd,wx_mdpd,"
            "wy_mdpd,wz_mdpd,contact_fraction,normal_force_mdpd,drive_x_mdpd,drive_y_mdpd,"
            "drive_z_mdpd,friction_x_mdpd,friction_y_mdpd,immersion,droplet,place") {
    if (!folder.empty()) std::filesystem::create_directories(folder);
  }

  void write(const engine::Snapshot& snapshot, const engine::Units& units) {
    if (!droplets_.wanted()) return;
    for (const auto& droplet : snapshot.droplets) add(droplet, snapshot, units);
    for (const auto& body : snapshot.microparticles) add(body, snapshot, units);
    droplets_.flush();
    microparticles_.flush();
  }

 private:
  void add(const engine::DropletObservation& d, const engine::Snapshot& snapshot,
           const engine::Units& units) {
    const double to_mm_per_s = units.velocity_m_per_s() * 1e3;
    droplets_.add(fmt::format(
        "{},{:.6g},{:.6g},{},{},{:.5f},{:.5f},{:.5f},{:.6f},{:.6f},{:.4f},{:.4f},{:.3f},{:.3f},{:.2f},{:."
        "2f},{:.5f}",
        snapshot.step, snapshot.time, snapshot.time * units.time_s, d.id, d.beads, d.centroid.x(),
        d.centroid.y(), d.centroid.z(), d.velocity.x(), d.velocity.y(), d.velocity.x() * to_mm_per_s,
        d.velocity.y() * to_mm_per_s, d.footprint_area, d.height, d.advancing_angle.value_or(NAN),
        d.receding_angle.value_or(NAN), snapshot.temperature));
  }

  void add(const engine::MicroparticleObservation& m, const engine::Snapshot& snapshot,
           const engine::Units& units) {
    constexpr std::array<const char*, 4> kPlaces{"dry", "front", "rear", "inside"};
    const auto vector = [](const engine::Vector3d& v) {
      return fmt::format("{:.6f},{:.6f},{:.6f}", v.x(), v.y(), v.z());
    };
    microparticles_.add(
        fmt::format("{},{:.6g},{:.6g},{},{},{},{},{:.3f},{:.5f},{},{:.5f},{:.5f},{:.4f},{},{}", snapshot.step,
                    snapshot.time, snapshot.time * units.time_s, m.id, vector(m.position), vector(m.velocity),
                    vector(m.angular_velocity), m.contact_fraction, m.normal_force, vector(m.drive_force),
                    m.friction_force.x(), m.friction_force.y(), m.immersion, m.droplet,
                    kPlaces.at(static_cast<std::size_t>(m.place))));
  }

  Table droplets_, microparticles_;
};

void write_checkpoint(const std::string& folder, const chip::Experiment& experiment) {
  const auto snapshot = experiment.observe({false, true});
  chip::Checkpoint checkpoint;
  checkpoint.scene = experiment.scene().name;
  checkpoint.seed = experiment.simulation().parameters().seed;
  checkpoint.step = snapshot->step;
  checkpoint.time = snapshot->time;
  checkpoint.state_hash = *snapshot->state_hash;
  checkpoint.state = experiment.save();
  chip::CheckpointFolder(folder).write(fmt::format("step_{:012}.checkpoint", snapshot->step), checkpoint);
}

/// The newest checkpoint that can be read. Damaged ones are named on standard error and passed over.
void resume_from(const std::string& folder, chip::Experiment& experiment) {
  const chip::CheckpointFolder checkpoints(folder);
  std::vector<std::string> names = checkpoints.names();
  names.erase(std::remove_if(names.begin(), names.end(),
                             [](const std::string& name) { return name.rfind("step_", 0) != 0; }),
              names.end());
  for (auto name = names.rbegin(); name != names.rend(); ++name) try {
      experiment.load(checkpoints.read(*name).state);
      return;
    } catch (const engine::InvalidInput& problem) {
      fmt::print(stderr, "{}: passed over: {}\n", *name, problem.what());
    }
  throw engine::InvalidInput(
      fmt::format("--resume: {}, allowed: a folder with a good step_*.checkpoint of this scene", folder));
}

std::uint64_t last_step(const RunOptions& options, const chip::Scene& scene) {
  if (options.steps) return *options.steps;
  const double until = options.until.value_or(scene.settle_time + scene.default_duration);
  return static_cast<std::uint64_t>(std::llround(until / scene.parameters.time_step));
}

}  // namespace

RunResult headless_run(const RunOptions& options) {
  const chip::Scene scene = chip::load_scene(options.scene);
  chip::Experiment experiment(scene, {options.threads, options.kernel}, options.seed);
  if (!options.resume.empty()) resume_from(options.resume, experiment);
  Log log(options.output, !options.resume.empty());

  interrupted = false;
  const auto previous_int = std::signal(SIGINT, on_interrupt),
             previous_term = std::signal(SIGTERM, on_interrupt);
  const std::uint64_t from = experiment.steps(), to = std::max(from, last_step(options, scene));
  double temperature_sum = 0, looks = 0, bead_steps = 0;
  const auto start = Clock::now();
  {
    Progress progress(from, to, options.quiet);
    while (experiment.steps() < to && !interrupted) {
      experiment.step();
      const std::uint64_t step = experiment.steps();
      if (step % scene.parameters.observe_interval == 0 || step == to) {
        const auto snapshot = experiment.observe();
        temperature_sum += snapshot->temperature;
        looks += 1;
        bead_steps += static_cast<double>(snapshot->moving_beads) * scene.parameters.observe_interval;
        log.write(*snapshot, scene.units);
        progress.show(step);
      }
      if (options.checkpoint_every > 0 && step % options.checkpoint_every == 0)
        write_checkpoint(options.output, experiment);
    }
  }
  if (interrupted && !options.output.empty()) write_checkpoint(options.output, experiment);
  std::signal(SIGINT, previous_int);
  std::signal(SIGTERM, previous_term);

  RunResult result;
  result.wall_s = seconds_since(start);
  const auto end = experiment.observe({false, true});
  result.scene = scene.name;
  result.kernel = experiment.simulation().kernel();
  result.threads = experiment.simulation().threads();
  result.beads = end->moving_beads;
  result.steps = end->step;
  result.time = end->time;
  result.ns_per_bead_step = bead_steps > 0 ? result.wall_s * 1e9 / bead_steps : 0;
  result.temperature = looks > 0 ? temperature_sum / looks : end->temperature;
  result.hash = *end->state_hash;
  return result;
}

std::string to_json(const RunResult& result) {
  nlohmann::ordered_json json;
  json["scene"] = result.scene;
  json["kernel"] = result.kernel;
  json["threads"] = result.threads;
  json["beads"] = result.beads;
  json["steps"] = result.steps;
  json["time"] = result.time;
  json["wall_s"] = result.wall_s;
  json["ns_per_bead_step"] = result.ns_per_bead_step;
  json["temperature"] = result.temperature;
  json["hash"] = fmt::format("{:016x}", result.hash);
  return json.dump();
}

}  // namespace dmf::tools
