#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "chip/hash_chain.h"
#include "chip/scene_files.h"

namespace dmf::bag_tools {

/// A command as it stands in a bag.
struct RecordedCommand {
  std::uint64_t step = 0;
  std::string name;
  std::string json;
};

struct RecordedCheckpoint {
  std::uint64_t step = 0;
  std::string name;  ///< of the file that was written or read; empty: none
  std::string data;  ///< what such a file holds
};

/// Why and where a run was halted.
struct RecordedFault {
  std::uint64_t step = 0;
  std::string message;
};

/// From a scene's start or from a checkpoint to the next reset, to the next load or to the end.
struct RecordedRun {
  std::uint32_t number = 0;  ///< as the chip counted
  std::uint64_t seed = 0;
  /// What ~commands says of commands that ~run_record tells otherwise, by place: one of both was altered.
  std::map<std::uint32_t, RecordedCommand> told_twice;
  std::map<std::uint32_t, RecordedCommand> commands;             ///< by place in the run's history
  std::map<std::uint32_t, chip::StateRecord> hashes;             ///< by place among the run's hashes
  std::multimap<std::uint64_t, RecordedCheckpoint> checkpoints;  ///< by step
  std::optional<RecordedFault> fault;

  /// How many commands there must have been.
  std::uint32_t commands_given() const;
};

/// What a bag holds of one chip node, from its start to its end. A node that was restarted is another one.
struct Session {
  std::uint64_t id = 0;  ///< ns of wall time at which it began
  std::string scene;     ///< name
  std::string version;   ///< of dmf_sim; empty: the bag lacks the scene
  std::uint64_t seed = 0;
  std::string kernel;
  std::uint32_t hash_interval = 0;
  std::uint64_t fingerprint = 0;  ///< of the scene, as the node had it
  std::vector<chip::SceneFile> files;
  std::map<std::uint32_t, RecordedRun> runs;  ///< by number
};

/// All of a chip in a bag that says how its runs came about.
struct BagRecord {
  std::string path;
  double duration = 0;                        ///< s of ROS time, from the first message to the last
  std::vector<Session> sessions;              ///< oldest first
  std::map<std::string, std::size_t> events;  ///< how many of each kind
};

/// Reads a bag. Messages that it holds twice, as a recorder that joins late gets them, count once.
/// @param chip  name of the node, such as "/chip".
/// @throws InvalidInput when it can't be read, was not closed, was written by a version with other messages,
/// or holds nothing of that node.
BagRecord read_bag(const std::string& path, const std::string& chip);

/// What a run's record lacks, a sentence each; empty when it is complete.
std::vector<std::string> gaps(const Session& session, const RecordedRun& run);

/// What in a record is not as the chip wrote it, a sentence each. Nothing is simulated for that.
std::vector<std::string> alterations(const Session& session, const RecordedRun& run);

/// Those of the run's first `count` commands that the record lacks, as text such as "3, 5-9"; empty: none.
std::string missing_commands(const RecordedRun& run, std::uint32_t count);

/// The run's commands from the first up to the first that is missing, ready to be applied.
/// @throws InvalidInput naming a command that can't be read.
std::vector<chip::CommandRecord> history(const RecordedRun& run);

/// Whether later records of the run hang on this one (see chip::HashChain). False when that can't be told, as
/// the one before it is missing.
bool is_link(const Session& session, const RecordedRun& run, const chip::StateRecord& record);

/// The hash chain of a run at its start, from the scene as the bag holds it.
chip::HashChain chain_of(const Session& session, const RecordedRun& run);

}  // namespace dmf::bag_tools
