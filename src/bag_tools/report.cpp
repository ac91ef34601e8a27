#include "bag_tools/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ctime>
#include <vector>

namespace dmf::bag_tools {

namespace {

std::string line(const std::string& name, const std::string& text) {
  return fmt::format("{:14} {}\n", name + ":", text);
}

/// "set_hv 1, set_electrodes 12", in the order of their first appearance.
std::string counts(const std::vector<std::string>& names) {
  std::vector<std::pair<std::string, std::size_t>> counted;
  for (const std::string& name : names) {
    auto found = counted.begin();
    while (found != counted.end() && found->first != name) ++found;
    if (found == counted.end()) found = counted.insert(found, {name, 0});
    ++found->second;
  }
  std::vector<std::string> parts;
  for (const auto& [name, count] : counted) parts.push_back(fmt::format("{} {}", name, count));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string date(std::uint64_t nanoseconds) {
  const auto seconds = static_cast<std::time_t>(nanoseconds / 1'000'000'000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[sizeof "2000-01-01 00:00:00 UTC"];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text;
}

std::string describe(const Session& session, const RecordedRun& run, bool list) {
  std::string text = fmt::format("\nrun {}, seed {}\n", run.number, run.seed);
  std::vector<std::string> names;
  for (const auto& [index, command] : run.commands) names.push_back(command.name);
  text += line("commands", names.empty() ? "none" : fmt::format("{}: {}", names.size(), counts(names)));
  if (list) {
    for (const auto& [index, command] : run.commands)
      text += fmt::format("    {:4}  step {:10}  {}\n", index, command.step, command.json);
  }
  if (!run.hashes.empty()) {
    const chip::StateRecord &first = run.hashes.begin()->second, &last = run.hashes.rbegin()->second;
    text +=
        line("state hashes", fmt::format("{}, from step {} to {}", run.hashes.size(), first.step, last.step));
    text += line("last", fmt::format("hash {:016x}, chain {:016x}", last.hash, last.chain));
  }
  for (const auto& [step, checkpoint] : run.checkpoints) {
    text += line("checkpoint", fmt::format("step {}, {} bytes{}", step, checkpoint.data.size(),
                                           checkpoint.name.empty() ? "" : ", " + checkpoint.name));
  }
  if (run.fault) text += line("halted", fmt::format("step {}: {}", run.fault->step, run.fault->message));
  const std::vector<std::string> missing = gaps(session, run), altered = alterations(session, run);
  for (const std::string& gap : missing) text += line("incomplete", gap);
  for (const std::string& alteration : altered) text += line("altered", alteration);
  if (missing.empty() && altered.empty())
    text += line("complete", "scene, commands and state hashes, and the hash chain holds");
  return text;
}

}  // namespace

std::string describe(const BagRecord& record, bool commands) {
  std::string text = line("bag", record.path);
  text += line("duration", fmt::format("{:.1f} s of ROS time", record.duration));
  std::vector<std::string> events;
  for (const auto& [kind, count] : record.events) events.push_back(fmt::format("{} {}", kind, count));
  text += line("events", events.empty() ? "none" : fmt::format("{}", fmt::join(events, ", ")));
  for (std::size_t i = 0; i < record.sessions.size(); ++i) {
    const Session& session = record.sessions[i];
    text += "\n";
    text += line("session", fmt::format("{}, node started {}", i + 1, date(session.id)));
    text += line("scene", session.version.empty()
                              ? "missing"
                              : fmt::format("{}, fingerprint {:016x}", session.scene, session.fingerprint));
    for (const chip::SceneFile& file : session.files)
      text += line("", fmt::format("{} {}, {} bytes", file.role, file.path, file.text.size()));
    text += line("seed", fmt::format("{}", session.seed));
    text += line("version", session.version);
    text += line("kernel", session.kernel);
    text += line("hash interval", fmt::format("{} steps", session.hash_interval));
    for (const auto& [number, run] : session.runs) text += describe(session, run, commands);
  }
  return text;
}

}  // namespace dmf::bag_tools
