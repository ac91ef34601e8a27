#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bag_tools/bag_record.h"
#include "yaml/invalid_input.h"

// What can be said of a record without simulating anything.

namespace dmf::bag_tools {

namespace {

/// The places from 0 up to `count` that a map lacks: "3, 5-9".
template <class Entry>
std::string missing(const std::map<std::uint32_t, Entry>& present, std::uint32_t count) {
  std::vector<std::string> gaps;
  const auto note = [&gaps](std::uint32_t first, std::uint32_t end) {
    if (first + 1 == end) gaps.push_back(fmt::format("{}", first));
    if (first + 1 < end) gaps.push_back(fmt::format("{}-{}", first, end - 1));
  };
  std::uint32_t next = 0;
  for (const auto& [index, entry] : present) {
    if (index >= count) break;
    note(next, index);
    next = index + 1;
  }
  note(next, count);
  return fmt::format("{}", fmt::join(gaps, ", "));
}

/// Where the chain does not follow from the scene, the commands and the hashes that the bag holds.
std::string broken_link(const Session& session, const RecordedRun& run) {
  const std::vector<chip::CommandRecord> commands = history(run);
  chip::HashChain chain = chain_of(session, run);
  bool linked = true;          // the links before are those that the chip had
  std::uint32_t next = 0;      // place of the record that must follow
  std::uint64_t sound_at = 0;  // step of the last record that is as it should be
  for (const auto& [index, record] : run.hashes) {
    linked = linked && index == next;
    next = index + 1;
    if (record.commands > commands.size()) return "";  // told as missing
    if (!linked) {
      if (!is_link(session, run, record)) continue;
      chain.adopt(record);
      linked = true;
    } else if (chain.add(record.step, record.hash, commands, record.commands).chain != record.chain) {
      if (index == 0) return "the scene, the seed or a command before its first hash";
      return fmt::format("a command or a hash between step {} and step {}", sound_at, record.step);
    }
    sound_at = record.step;
  }
  return "";
}

}  // namespace

std::uint32_t RecordedRun::commands_given() const {
  const std::uint32_t known = commands.empty() ? 0 : commands.rbegin()->first + 1;
  return hashes.empty() ? known : std::max(known, hashes.rbegin()->second.commands);
}

std::string missing_commands(const RecordedRun& run, std::uint32_t count) {
  return missing(run.commands, count);
}

std::vector<chip::CommandRecord> history(const RecordedRun& run) {
  std::vector<chip::CommandRecord> result;
  for (const auto& [index, command] : run.commands) {
    if (index != result.size()) break;
    try {
      result.push_back({command.step, chip::command_from_json(command.json)});
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("run {}: command {} at step {} can't be read: {}", run.number, index,
                                     command.step, error.what()));
    }
  }
  return result;
}

bool is_link(const Session& session, const RecordedRun& run, const chip::StateRecord& record) {
  if (record.index == 0) return true;
  const auto before = run.hashes.find(record.index - 1);
  return before != run.hashes.end() && before->second.step < record.step &&
         record.step % session.hash_interval == 0;
}

chip::HashChain chain_of(const Session& session, const RecordedRun& run) {
  return {chip::fingerprint(chip::SceneFiles::recorded(session.files)), run.seed, session.hash_interval};
}

std::vector<std::string> gaps(const Session& session, const RecordedRun& run) {
  std::vector<std::string> found;
  if (session.version.empty()) found.push_back("the scene is missing (~scene was not recorded)");
  const std::string commands = missing_commands(run, run.commands_given());
  if (!commands.empty()) found.push_back(fmt::format("commands are missing: {}", commands));
  if (run.hashes.empty()) {
    found.push_back("there are no state hashes (~hash_interval was 0, or ~run_record was not recorded)");
    return found;
  }
  const std::string hashes = missing(run.hashes, run.hashes.rbegin()->first + 1);
  if (!hashes.empty()) found.push_back(fmt::format("state hashes are missing: {}", hashes));
  return found;
}

std::vector<std::string> alterations(const Session& session, const RecordedRun& run) {
  std::vector<std::string> found;
  if (session.version.empty()) return found;  // told as missing
  if (chip::fingerprint(chip::SceneFiles::recorded(session.files)) != session.fingerprint)
    found.push_back("the texts of the scene are not those of its fingerprint");
  for (const auto& [index, command] : run.told_twice) {
    const RecordedCommand& other = run.commands.at(index);
    found.push_back(fmt::format("command {} is {} at step {} and {} at step {}", index, other.json,
                                other.step, command.json, command.step));
  }
  if (session.hash_interval > 0) {
    const std::string where = broken_link(session, run);
    if (!where.empty()) found.push_back(fmt::format("the hash chain does not hold: {}", where));
  }
  return found;
}

}  // namespace dmf::bag_tools
