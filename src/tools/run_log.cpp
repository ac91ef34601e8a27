#include "tools/run_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace dmf::tools {
namespace {

constexpr const char* kDropletHead =
    "step,time_mdpd,time_s,droplet,beads,x_mdpd,y_mdpd,z_mdpd,vx_mdpd,vy_mdpd,vx_mm_per_s,vy_mm_per_s,"
    "footprint_area_mdpd,height_mdpd,advancing_deg,receding_deg,temperature";
constexpr const char* kMicroparticleHead =
    "step,time_mdpd,time_s,microparticle,x_mdpd,y_mdpd,z_mdpd,vx_mdpd,vy_mdpd,vz_mdpd,wx_mdpd,wy_mdpd,wz_"
    "mdpd,"
    "contact_fraction,normal_force_mdpd,drive_x_mdpd,drive_y_mdpd,drive_z_mdpd,friction_x_mdpd,friction_y_"
    "mdpd,"
    "immersion,droplet,place";
constexpr const char* kChainHead =
    "step,time_mdpd,time_s,chain,beads,x_mdpd,y_mdpd,z_mdpd,end_to_end_x_mdpd,end_to_end_y_mdpd,end_to_end_z_"
    "mdpd,radius_of_gyration_mdpd,contour_length_mdpd,longest_bond_mdpd,energy_mdpd";
constexpr const char* kMembraneHead =
    "step,time_mdpd,time_s,membrane,beads,x_mdpd,y_mdpd,z_mdpd,area_mdpd,volume_mdpd,reduced_volume,length_x_"
    "mdpd,length_y_mdpd,length_z_mdpd,gyration_short_mdpd,gyration_middle_mdpd,gyration_long_mdpd,longest_"
    "edge_"
    "mdpd,energy_mdpd";

std::string text_of(const engine::Vector3d& v) {
  return fmt::format("{:.5f},{:.5f},{:.5f}", v.x(), v.y(), v.z());
}

[[noreturn]] void refused(const std::string& file) {
  throw std::runtime_error(fmt::format("{}: write failed; is the disk full?", file));
}

}  // namespace

Table::Table(const std::string& folder, const char* name, const std::string& head,
             std::optional<std::uint64_t> kept)
    : file_(folder.empty() ? "" : folder + "/" + name), head_(head) {
  if (!wanted()) return;
  if (kept)
    cut(*kept);
  else
    std::filesystem::remove(file_);
}

void Table::cut(std::uint64_t kept) const {
  std::ifstream in(file_);
  if (!in) return;
  std::string line;
  std::uintmax_t good = 0;
  // A last line without its end counts as not written: getline() meets the end of the file then.
  while (std::getline(in, line) && !in.eof()) {
    if (good == 0 && line != head_)
      throw std::runtime_error(fmt::format("{}: has other columns, allowed: another --out folder", file_));
    if (good > 0 && std::strtoull(line.c_str(), nullptr, 10) > kept) break;
    good += line.size() + 1;
  }
  in.close();
  if (good == 0)
    std::filesystem::remove(file_);
  else
    std::filesystem::resize_file(file_, good);
}

void Table::add(const std::string& line) {
  if (!wanted()) return;
  if (!out_.is_open()) {
    const bool fresh = !std::filesystem::exists(file_);
    out_.open(file_, std::ios::app);
    if (!out_) throw std::runtime_error(fmt::format("{}: can't be written", file_));
    if (fresh) out_ << head_ << '\n';
  }
  out_ << line << '\n';
}

void Table::flush() {
  if (!out_.is_open()) return;
  out_.flush();
  if (!out_) refused(file_);
}

void Table::sync() {
  flush();
  if (!out_.is_open()) return;
  // A stream does not show its descriptor; any descriptor flushes the whole file.
  const int descriptor = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
  if (descriptor >= 0) ::close(descriptor);
  if (!done) refused(file_);
}

RunLog::RunLog(const std::string& folder, std::optional<std::uint64_t> kept)
    : droplets_(folder, "droplets.csv", kDropletHead, kept),
      microparticles_(folder, "microparticles.csv", kMicroparticleHead, kept),
      chains_(folder, "chains.csv", kChainHead, kept),
      membranes_(folder, "membranes.csv", kMembraneHead, kept) {}

void RunLog::write(const engine::Snapshot& snapshot, const engine::Units& units) {
  if (!droplets_.wanted()) return;
  for (const auto& droplet : snapshot.droplets) add(droplet, snapshot, units);
  for (const auto& body : snapshot.microparticles) add(body, snapshot, units);
  for (const auto& chain : snapshot.chains) add(chain, snapshot, units);
  for (const auto& membrane : snapshot.membranes) add(membrane, snapshot, units);
  for (Table* table : {&droplets_, &microparticles_, &chains_, &membranes_}) table->flush();
}

void RunLog::sync() {
  for (Table* table : {&droplets_, &microparticles_, &chains_, &membranes_}) table->sync();
}

void RunLog::add(const engine::DropletObservation& d, const engine::Snapshot& snapshot,
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

void RunLog::add(const engine::MicroparticleObservation& m, const engine::Snapshot& snapshot,
                 const engine::Units& units) {
  constexpr std::array<const char*, 4> kPlaces{"dry", "front", "rear", "inside"};
  const auto vector = [](const engine::Vector3d& v) {
    return fmt::format("{:.6f},{:.6f},{:.6f}", v.x(), v.y(), v.z());
  };
  microparticles_.add(fmt::format("{},{:.6g},{:.6g},{},{},{},{},{:.3f},{:.5f},{},{:.5f},{:.5f},{:.4f},{},{}",
                                  snapshot.step, snapshot.time, snapshot.time * units.time_s, m.id,
                                  vector(m.position), vector(m.velocity), vector(m.angular_velocity),
                                  m.contact_fraction, m.normal_force, vector(m.drive_force),
                                  m.friction_force.x(), m.friction_force.y(), m.immersion, m.droplet,
                                  kPlaces.at(static_cast<std::size_t>(m.place))));
}

void RunLog::add(const engine::ChainObservation& c, const engine::Snapshot& snapshot,
                 const engine::Units& units) {
  chains_.add(fmt::format("{},{:.6g},{:.6g},{},{},{},{},{:.5f},{:.5f},{:.5f},{:.5f}", snapshot.step,
                          snapshot.time, snapshot.time * units.time_s, c.id, c.beads.size(),
                          text_of(c.centroid), text_of(c.end_to_end), c.radius_of_gyration, c.contour_length,
                          c.longest_bond, c.energy));
}

void RunLog::add(const engine::MembraneObservation& m, const engine::Snapshot& snapshot,
                 const engine::Units& units) {
  membranes_.add(fmt::format("{},{:.6g},{:.6g},{},{},{},{:.5f},{:.5f},{:.6f},{},{},{:.5f},{:.5f}",
                             snapshot.step, snapshot.time, snapshot.time * units.time_s, m.id, m.beads.size(),
                             text_of(m.centroid), m.area, m.volume, m.reduced_volume,
                             text_of(m.upper - m.lower), text_of(m.gyration_radii), m.longest_edge,
                             m.energy.total()));
}

}  // namespace dmf::tools
