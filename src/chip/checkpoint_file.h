#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace dmf::chip {

class Experiment;

/// A run as it lies in a checkpoint file. `state` is opaque here: what Experiment::save() gave.
struct Checkpoint {
  std::string package_version;   ///< of dmf_sim that wrote it; write() fills it in
  std::string scene;             ///< name of the scene
  std::uint64_t scene_hash = 0;  ///< of what decides how its runs go, see scene_hash.h; 0: of no scene
  std::uint64_t seed = 0;
  std::uint64_t step = 0;
  double time = 0;               ///< tau
  std::uint64_t state_hash = 0;  ///< of the state, as dmf_run prints it
  // What a node goes on with; 0 and false from elsewhere.
  std::uint64_t ros_time = 0;  ///< ns
  std::uint32_t run = 0;       ///< run number
  bool paused = false;
  std::string state;
};

/// The run as it is now; what only a node knows is left for it.
Checkpoint checkpoint_of(const Experiment& experiment);

/// A checkpoint as the bytes of its file.
std::string encode(const Checkpoint& checkpoint);
/// And back. @param name  of the file, for messages. @throws engine::InvalidInput when the bytes are damaged,
/// cut off, of another version or no checkpoint.
Checkpoint decode(const std::string& data, const std::string& name);

/// A folder of checkpoints that strangers may name files in: every name must be bare, and neither the
/// folder's surroundings nor anything that a symbolic link points at can be reached through one.
///
/// File format, version 2: a line "dmf_sim checkpoint 2", a line of JSON with the fields above and the
/// state's size in bytes (`head -n 2 FILE` shows both), the state, and a last line "crc64 <16 hex digits>"
/// over all that stands before it.
class CheckpointFolder {
 public:
  /// @param folder  created, with its parents, when the first checkpoint is written.
  explicit CheckpointFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Writes a checkpoint so that a crash leaves either the old file or the new one: to a temporary, flushed
  /// to the disk, then renamed. Replaces a checkpoint of that name.
  /// @throws engine::InvalidInput on a bad name; std::runtime_error with the reason when the disk refuses.
  void write(const std::string& name, const Checkpoint& checkpoint) const;

  /// @throws engine::InvalidInput on a bad name, and when there is no such file or it is damaged, cut off, of
  /// another version or no checkpoint.
  Checkpoint read(const std::string& name) const;

  /// Names of the regular files in the folder, sorted; empty when there is no folder.
  std::vector<std::string> names() const;

  /// Takes a checkpoint away, if it is there. @throws engine::InvalidInput on a bad name.
  void remove(const std::string& name) const;
  /// Takes away what processes that were killed while they wrote left of checkpoints whose names begin so.
  /// Nobody may be writing one of them.
  void remove_leftovers(const std::string& prefix) const;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace dmf::chip
