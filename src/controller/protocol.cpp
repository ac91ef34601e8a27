#include "controller/protocol.h"

#include <fmt/format.h>

#include <algorithm>

#include "yaml/yaml_reader.h"

namespace dmf::controller {

namespace {

constexpr std::uint64_t kMostChannel = 0xffffffff;
constexpr double kMostFrequency = 100e3;  ///< Hz, as ~set_hv takes it

Channel read_channel(const YamlReader& reader, const std::string& key) {
  return static_cast<Channel>(reader.integer(key, 0, kMostChannel));
}

std::vector<Channel> read_channels(const YamlReader& reader, const std::string& key) {
  std::vector<Channel> channels;
  for (const std::uint64_t channel : reader.integers(key, 0, kMostChannel, {}))
    channels.push_back(static_cast<Channel>(channel));
  return channels;
}

std::vector<Channel> read_optional_channels(const YamlReader& reader, const std::string& key) {
  return reader.has(key) ? read_channels(reader, key) : std::vector<Channel>{};
}

Limits read_limits(const YamlReader& reader, const Limits& defaults) {
  Limits limits;
  limits.success_threshold = reader.number("success_threshold", {0, 1, true}, defaults.success_threshold);
  limits.step_timeout =
      reader.quantity("step_timeout", Dimension::time, Range::above(0), defaults.step_timeout);
  limits.retries = static_cast<unsigned>(reader.integer("retries", 0, 100, defaults.retries));
  limits.timeout = reader.quantity("timeout", Dimension::time, Range::at_least(0), defaults.timeout);
  return limits;
}

/// What a file says as a whole, for all its steps.
struct Ground {
  const Layout& layout;
  double max_voltage;
  Limits limits;
};

Goal read_goal(const std::string& kind, const YamlReader& reader, const Limits& limits) {
  if (kind == "move") {
    Move goal;
    goal.channel = read_channel(reader, "channel");
    goal.path = read_optional_channels(reader, "path");
    if (goal.path.empty()) {
      goal.to = read_channel(reader, "to");
    } else if (reader.has("to")) {
      reader.report("to", "given together with path, allowed: one of both");
    }
    goal.limits = limits;
    return goal;
  }
  if (kind == "split")
    return Split{read_channel(reader, "channel"), read_optional_channels(reader, "onto"), limits};
  if (kind == "merge") return Merge{read_channel(reader, "channel"), read_channel(reader, "into"), limits};
  if (kind == "dispense") {
    return Dispense{read_channel(reader, "reservoir"), read_channels(reader, "path"),
                    reader.number("least", Range::at_least(0), 0.0),
                    reader.number("most", Range::at_least(0), 0.0), limits};
  }
  return Mix{read_channel(reader, "channel"), read_optional_channels(reader, "loop"),
             static_cast<unsigned>(reader.integer("laps", 1, 1000, 1)), limits};
}

const std::vector<std::string>& operation_names() {
  static const std::vector<std::string> names{name_of(Move{}), name_of(Split{}), name_of(Merge{}),
                                              name_of(Dispense{}), name_of(Mix{})};
  return names;
}

/// The operation under the key `kind`, with what is wrong with it on this board.
Goal read_operation(const std::string& kind, const YamlReader& step, const Ground& ground) {
  const YamlReader reader = step.mapping(kind);
  const Goal goal = read_goal(kind, reader, read_limits(reader, ground.limits));
  for (const std::string& violation : violations(goal, ground.layout)) {
    const std::size_t colon = violation.find(": ");
    const std::string key = violation.substr(0, colon);
    // What is missing has been told.
    if (reader.has(key)) reader.report(key, violation.substr(colon + 2));
  }
  return goal;
}

/// The one of these keys that a mapping has; empty, and noted, when there are none or several.
std::string only_key(const YamlReader& reader, const std::vector<std::string>& allowed) {
  std::vector<std::string> given;
  for (const std::string& key : allowed)
    if (reader.has(key)) given.push_back(key);
  if (given.size() == 1) return given.front();
  // All are known from here on: a misspelt one is told with the one that it is near to.
  if (given.empty()) {
    for (const std::string& key : allowed) reader.text(key, "");
  } else {
    reader.keys();
  }
  reader.report(
      "", fmt::format("{}, allowed: one of {}",
                      given.empty() ? "nothing to do" : fmt::format("{} at once", fmt::join(given, ", ")),
                      fmt::join(allowed, ", ")));
  return "";
}

Activate read_activate(const YamlReader& reader, const Ground& ground) {
  Activate step;
  for (const Channel channel : read_channels(reader, "channels")) {
    if (!ground.layout.has(channel)) {
      reader.report("channels", fmt::format("channel {} does not exist, allowed: {}", channel,
                                            channels_text(ground.layout.channels())));
    }
    if (!step.channels.insert(channel).second)
      reader.report("channels", fmt::format("{} twice, allowed: each channel once", channel));
  }
  step.duration = reader.quantity("duration", Dimension::time, Range::above(0));
  if (reader.has("volume_threshold")) {
    step.volume_threshold = reader.number("volume_threshold", {0, 1, true});
    if (step.channels.empty()) reader.report("volume_threshold", "allowed: beside channels that are on");
  }
  return step;
}

Step read_step(const YamlReader& reader, const Ground& ground) {
  Step step;
  step.name = reader.text("name", "");
  if (reader.has("voltage"))
    step.voltage = reader.quantity("voltage", Dimension::voltage, {0, ground.max_voltage, true});
  if (reader.has("frequency"))
    step.frequency = reader.quantity("frequency", Dimension::frequency, {0, kMostFrequency});
  std::vector<std::string> kinds{"channels", "wait", "parallel"};
  kinds.insert(kinds.end(), operation_names().begin(), operation_names().end());
  const std::string kind = only_key(reader, kinds);
  if (kind == "channels") {
    step.work = read_activate(reader, ground);
  } else if (kind == "wait") {
    step.work = Wait{reader.quantity("wait", Dimension::time, Range::above(0))};
  } else if (kind == "parallel") {
    Parallel parallel;
    const std::vector<YamlReader> entries = reader.mappings("parallel");
    if (entries.empty()) reader.report("parallel", "no operation, allowed: one or more");
    for (const YamlReader& entry : entries) {
      const std::string operation = only_key(entry, operation_names());
      if (!operation.empty()) parallel.goals.push_back(read_operation(operation, entry, ground));
    }
    step.work = parallel;
  } else if (!kind.empty()) {
    step.work = Parallel{{read_operation(kind, reader, ground)}};
  }
  if (step.name.empty()) step.name = kind;
  return step;
}

Protocol read_protocol(const YamlReader& root, const Layout& layout, double max_voltage) {
  Protocol protocol;
  protocol.name = root.text("name", "");
  const auto limits = root.optional_mapping("limits");
  const Ground ground{layout, max_voltage, limits ? read_limits(*limits, {}) : Limits{}};
  std::optional<double> voltage, frequency;
  if (root.has("voltage")) voltage = root.quantity("voltage", Dimension::voltage, {0, max_voltage, true});
  if (root.has("frequency"))
    frequency = root.quantity("frequency", Dimension::frequency, {0, kMostFrequency});
  for (const YamlReader& entry : root.mappings("steps")) protocol.steps.push_back(read_step(entry, ground));
  if (protocol.steps.empty()) {
    root.report("steps", "no steps, allowed: one or more");
  } else {
    Step& first = protocol.steps.front();
    if (!first.voltage) first.voltage = voltage;
    if (!first.frequency) first.frequency = frequency;
  }
  root.finish();
  return protocol;
}

}  // namespace

Protocol load_protocol(const std::string& file, const Layout& layout, double max_voltage) {
  return read_protocol(YamlReader::load(file), layout, max_voltage);
}

Protocol parse_protocol(const std::string& text, const std::string& name, const Layout& layout,
                        double max_voltage) {
  return read_protocol(YamlReader::parse(text, name), layout, max_voltage);
}

}  // namespace dmf::controller
