#include "tools/transport.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "chip/experiment.h"
#include "engine/archive.h"
#include "tools/largest_droplet.h"
#include "tools/processes.h"
#include "tools/saved_run.h"

namespace dmf::tools {
namespace {

using engine::DropletObservation;
using engine::MicroparticleEvent;
using engine::MicroparticleObservation;
using engine::MicroparticleTotals;

struct Column {
  const char* name;
  double TransportRecord::*value;
};
constexpr Column columns[] = {{"microparticle", &TransportRecord::microparticle},
                              {"time", &TransportRecord::time},
                              {"x", &TransportRecord::x},
                              {"y", &TransportRecord::y},
                              {"z", &TransportRecord::z},
                              {"height", &TransportRecord::height},
                              {"contact_fraction", &TransportRecord::contact_fraction},
                              {"normal_force", &TransportRecord::normal_force},
                              {"drive_x", &TransportRecord::drive_x},
                              {"drive_z", &TransportRecord::drive_z},
                              {"friction_x", &TransportRecord::friction_x},
                              {"immersion", &TransportRecord::immersion},
                              {"place", &TransportRecord::place},
                              {"carrier", &TransportRecord::carrier},
                              {"picked_up", &TransportRecord::picked_up},
                              {"dropped_off", &TransportRecord::dropped_off},
                              {"droplets", &TransportRecord::droplets},
                              {"droplet", &TransportRecord::droplet},
                              {"droplet_x", &TransportRecord::droplet_x},
                              {"droplet_y", &TransportRecord::droplet_y},
                              {"droplet_z", &TransportRecord::droplet_z}};

std::string header() {
  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + std::string(column.name);
  return text;
}

std::string as_csv(const std::vector<TransportRecord>& records) {
  std::string text = header() + "\n";
  for (const TransportRecord& record : records) {
    const char* separator = "";
    for (const Column& column : columns) {
      text += fmt::format("{}{:.9g}", separator, record.*column.value);
      separator = ",";
    }
    text += "\n";
  }
  return text;
}

/// Looks at an experiment again and again, and knows what the last look has seen.
class Recorder {
 public:
  explicit Recorder(chip::Experiment& experiment) : experiment_(experiment) {
    remember(*experiment.observe());
  }

  /// The records of now, one a microparticle.
  std::vector<TransportRecord> look() {
    const auto snapshot = experiment_.observe();
    const std::vector<MicroparticleEvent> events = experiment_.take_microparticle_events();
    experiment_.take_events();  // kept until somebody takes them
    TransportRecord common;
    common.time = snapshot->time - experiment_.scene().settle_time;
    common.droplets = static_cast<double>(snapshot->droplets.size());
    const DropletObservation* droplet = largest_droplet(*snapshot);
    common.droplet = droplet ? droplet->id : 0;
    common.droplet_x = droplet ? droplet->centroid.x() : NAN;
    common.droplet_y = droplet ? droplet->centroid.y() : NAN;
    common.droplet_z = droplet ? droplet->centroid.z() : NAN;
    std::vector<TransportRecord> records;
    for (const MicroparticleObservation& body : snapshot->microparticles) {
      records.push_back(record_of(body, common));
      for (const MicroparticleEvent& event : events) {
        if (event.microparticle != body.id) continue;
        (event.kind == MicroparticleEvent::Kind::picked_up ? records.back().picked_up
                                                           : records.back().dropped_off) += 1;
      }
    }
    if (records.empty()) {
      common.x = common.y = common.z = common.height = NAN;
      records.push_back(common);
    }
    remember(*snapshot);
    return records;
  }

 private:
  TransportRecord record_of(const MicroparticleObservation& body, TransportRecord record) const {
    record.microparticle = body.id;
    record.x = body.position.x();
    record.y = body.position.y();
    record.z = body.position.z();
    record.immersion = body.immersion;
    record.place = static_cast<double>(body.place);
    record.carrier = body.droplet;
    const auto before = totals_.find(body.id);
    const MicroparticleTotals then = before == totals_.end() ? MicroparticleTotals{} : before->second;
    const MicroparticleTotals& now = body.totals;
    const auto steps = static_cast<double>(now.steps - then.steps);
    const auto mean = [steps](double sum) { return steps > 0 ? sum / steps : NAN; };
    record.height = mean(now.height - then.height);
    record.contact_fraction = mean(static_cast<double>(now.steps_in_contact - then.steps_in_contact));
    record.normal_force = mean(now.normal_force - then.normal_force);
    record.drive_x = mean(now.drive_force.x() - then.drive_force.x());
    record.drive_z = mean(now.drive_force.z() - then.drive_force.z());
    record.friction_x = mean(now.friction_force.x() - then.friction_force.x());
    return record;
  }

  void remember(const engine::Snapshot& snapshot) {
    for (const MicroparticleObservation& body : snapshot.microparticles) totals_[body.id] = body.totals;
  }

  chip::Experiment& experiment_;
  std::map<std::uint32_t, MicroparticleTotals> totals_;  ///< at the last look, by id
};

/// What has become of the microparticles so far: follows from the records, so that it needs no saving.
class Course {
 public:
  Course(const TransportRun& run, const std::vector<TransportRecord>& so_far) : run_(run) {
    for (const TransportRecord& record : so_far) add(record);
  }

  void add(const TransportRecord& record) {
    if (bodies_.empty()) start_ = record.time;
    time_ = record.time;
    Body& body = bodies_[record.microparticle];
    const double x = record.microparticle > 0 ? record.x : record.droplet_x;
    if (std::isnan(body.start)) body.start = x;
    body.x = x;
    body.arrived = body.arrived || x >= run_.goal;
    body.behind = record.droplet_x - record.x;
    // The largest droplet is the one that travels: a satellite that stays with the microparticle carries
    // nothing. When the satellite merges into it, it has the microparticle again, without an event.
    const bool has_it = record.carrier > 0 && record.carrier == record.droplet;
    if (has_it) {
      ever_picked_up_ = body.carried = true;
      body.dropped_off = NAN;
    } else if (record.dropped_off > 0) {
      body.carried = false;
      body.dropped_off = record.time;
    }
  }

  bool over() const {
    if (time_ >= run_.limit) return true;
    bool arrived = !bodies_.empty(), carried = false, missed = !ever_picked_up_ && !bodies_.empty();
    double last_drop_off = NAN;
    for (const auto& [id, body] : bodies_) {
      arrived = arrived && body.arrived;
      carried = carried || body.carried;
      missed = missed && body.behind > run_.missed;  // never without microparticles: NaN
      last_drop_off = std::fmax(last_drop_off, body.dropped_off);
    }
    return arrived || missed || (!carried && time_ >= last_drop_off + run_.after_drop_off);
  }

  /// How much of it is over at least, 0 to 1: by the clock, or by the way of the slowest.
  double share_done() const {
    if (bodies_.empty()) return 0;
    double way = 1;
    for (const auto& [id, body] : bodies_) {
      const double part = body.arrived ? 1 : (body.x - body.start) / (run_.goal - body.start);
      way = std::min(way, part > 0 ? part : 0);  // not a number while there is no droplet
    }
    return std::clamp((time_ - start_) / (run_.limit - start_), way, 1.0);
  }

 private:
  struct Body {
    bool arrived = false, carried = false;
    double start = NAN, x = NAN;  ///< at the first look and now, r_c
    double behind = NAN;          ///< the droplet, r_c
    double dropped_off = NAN;     ///< time, until the droplet has it again
  };
  const TransportRun& run_;
  bool ever_picked_up_ = false;
  double start_ = 0, time_ = -std::numeric_limits<double>::infinity();
  std::map<double, Body> bodies_;  ///< by id
};

std::string state_of(const chip::Experiment& experiment, std::vector<TransportRecord> records) {
  const std::string saved = experiment.save();
  std::vector<char> bytes(saved.begin(), saved.end());
  engine::Archive archive;
  archive(records);
  archive(bytes);
  return archive.take();
}

/// @returns the records up to the state.
std::vector<TransportRecord> restore(const std::string& state, chip::Experiment& experiment) {
  engine::Archive archive(state);
  std::vector<TransportRecord> records;
  std::vector<char> bytes;
  archive(records);
  archive(bytes);
  experiment.load({bytes.begin(), bytes.end()});
  return records;
}

}  // namespace

std::vector<TransportRecord> read_records(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line) || line != header())
    throw std::runtime_error(fmt::format("{}: no record of a transport run; move it away", file));
  std::vector<TransportRecord> records;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string field;
    TransportRecord record;
    for (const Column& column : columns) {
      if (!std::getline(fields, field, ','))
        throw std::runtime_error(fmt::format("{}: line {} ends early", file, records.size() + 2));
      record.*column.value = std::strtod(field.c_str(), nullptr);
    }
    records.push_back(record);
  }
  return records;
}

Transport run_transport(const chip::Scene& scene, std::uint64_t seed, const TransportRun& run) {
  const std::string base = run.folder + "/" + file_name(run.key), file = base + ".csv",
                    part = base + ".part.csv";
  if (std::filesystem::exists(file)) return {read_records(file), {}, NAN};

  chip::Experiment experiment(scene, {1, "auto"}, seed);
  SavedRun saved(run.folder, run.key, run.save_every);
  std::vector<TransportRecord> records;
  if (const auto state = saved.load()) records = restore(*state, experiment);
  Recorder recorder(experiment);
  Course course(run, records);
  const auto steps_between =
      static_cast<std::uint64_t>(std::max(1.0, std::round(run.record_every / scene.parameters.time_step)));
  while (!course.over()) {
    tell_share_done(course.share_done());
    do experiment.step();
    while (experiment.steps() % steps_between != 0);
    for (const TransportRecord& record : recorder.look()) {
      records.push_back(record);
      course.add(record);
    }
    if (run.after_record) run.after_record(records.back());
    if (saved.due() && !course.over()) {
      replace_file(part, as_csv(records));
      saved.save(state_of(experiment, records), seed, experiment.steps());
    }
  }
  replace_file(file, as_csv(records));
  saved.remove();
  std::filesystem::remove(part);
  // From the file, so that what is measured now is what is measured when the file is read again.
  return {read_records(file), experiment.observe({false, true})->state_hash, saved.earlier_computing()};
}

}  // namespace dmf::tools
