#pragma once
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "engine/observe/snapshot.h"
#include "engine/units.h"

namespace dmf::tools {

/// A table in a file that is there once it has a line, whose lines begin with their step. Without a folder it
/// keeps nothing.
class Table {
 public:
  /// @param kept  the last step whose lines stay when a run goes on: what came later, and a line that was cut
  /// off, is written again. Empty: a new run, nothing stays.
  Table(const std::string& folder, const char* name, const std::string& head,
        std::optional<std::uint64_t> kept);

  bool wanted() const { return !file_.empty(); }
  void add(const std::string& line);
  /// What was added is in the file, whatever happens to the process. @throws std::runtime_error when the disk
  /// refuses.
  void flush();
  /// And on the disk, whatever happens to the machine.
  void sync();

 private:
  void cut(std::uint64_t kept) const;

  std::string file_, head_;
  std::ofstream out_;
};

/// One line a look and droplet, microparticle, chain or membrane; droplets in SI units beside reduced ones.
class RunLog {
 public:
  /// @param kept  as Table has it.
  RunLog(const std::string& folder, std::optional<std::uint64_t> kept);

  void write(const engine::Snapshot& snapshot, const engine::Units& units);
  void sync();

 private:
  void add(const engine::DropletObservation& droplet, const engine::Snapshot& snapshot,
           const engine::Units& units);
  void add(const engine::MicroparticleObservation& body, const engine::Snapshot& snapshot,
           const engine::Units& units);
  void add(const engine::ChainObservation& chain, const engine::Snapshot& snapshot,
           const engine::Units& units);
  void add(const engine::MembraneObservation& membrane, const engine::Snapshot& snapshot,
           const engine::Units& units);

  Table droplets_, microparticles_, chains_, membranes_;
};

}  // namespace dmf::tools
