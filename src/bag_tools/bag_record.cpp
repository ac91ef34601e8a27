#include "bag_tools/bag_record.h"

#include <dmf_sim/CheckpointFile.h>
#include <dmf_sim/Command.h>
#include <dmf_sim/Event.h>
#include <dmf_sim/RunRecord.h>
#include <dmf_sim/Scene.h>
#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include "yaml/invalid_input.h"

namespace dmf::bag_tools {

namespace {

/// What 16 hex digits say.
std::uint64_t number_of(const std::string& hex) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), value, 16);
  if (error != std::errc() || end != hex.data() + hex.size() || hex.size() != 16)
    throw InvalidInput(fmt::format("state hash: \"{}\", allowed: 16 hex digits", hex));
  return value;
}

void open(rosbag::Bag& bag, const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw InvalidInput(fmt::format("{}: is no file", path));
  const auto refuse = [&path](const char* why) {
    throw InvalidInput(fmt::format("{}: {}, allowed: after `rosbag reindex {}`", path, why, path));
  };
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    refuse("was not closed, its recorder was killed");
  } catch (const rosbag::BagIOException&) {
    refuse("is cut off");
  } catch (const rosbag::BagException& problem) {
    throw InvalidInput(fmt::format("{}: {}", path, problem.what()));
  }
}

/// Puts the messages of a bag where they belong.
class Reader {
 public:
  Reader(BagRecord& record, const std::string& chip) : record_(record), chip_(chip) {}

  std::vector<std::string> topics() const {
    std::vector<std::string> names;
    for (const char* name : {"scene", "commands", "run_record", "checkpoint", "events"})
      names.push_back(chip_ + "/" + name);
    return names;
  }

  void take(const rosbag::MessageInstance& message) {
    ++count_;
    const std::string name = message.getTopic().substr(chip_.size() + 1);
    if (name == "scene") add(*instance<dmf_sim::Scene>(message));
    if (name == "commands") add(*instance<dmf_sim::Command>(message));
    if (name == "run_record") add(*instance<dmf_sim::RunRecord>(message));
    if (name == "checkpoint") add(*instance<dmf_sim::CheckpointFile>(message));
    if (name == "events") events_.push_back(instance<dmf_sim::Event>(message));
  }

  void finish() {
    // Those of ~run_record are the ones that the hash chain counts.
    for (const auto& [run, message] : heard_) {
      const RecordedCommand command{message.step, message.name, message.json};
      const auto [there, fresh] = run->commands.emplace(message.index, command);
      if (!fresh && (there->second.step != command.step || there->second.json != command.json))
        run->told_twice.emplace(message.index, command);
    }
    if (count_ == 0) {
      throw InvalidInput(fmt::format(
          "{}: holds nothing on {}, allowed: the bag of a chip (its node's name is set with --chip)",
          record_.path, fmt::join(topics(), ", ")));
    }
    for (auto& [id, session] : sessions_) {
      for (auto& [number, run] : session.runs) {
        if (run.hashes.empty()) run.seed = session.seed;
      }
    }
    for (const auto& event : events_) {
      ++record_.events[event->kind];
      // Events don't say of which of two nodes they are.
      if (event->kind != dmf_sim::Event::FAULT || sessions_.size() != 1) continue;
      run(sessions_.begin()->first, event->run).fault = RecordedFault{event->step, event->message};
    }
    for (auto& [id, session] : sessions_) record_.sessions.push_back(std::move(session));
  }

 private:
  template <class Message>
  static boost::shared_ptr<Message> instance(const rosbag::MessageInstance& message) {
    auto result = message.instantiate<Message>();
    if (!result) {
      throw InvalidInput(
          fmt::format("{}: its messages ({}) have other fields here, allowed: a bag recorded with this "
                      "version of dmf_sim, " DMF_SIM_VERSION,
                      message.getTopic(), message.getDataType()));
    }
    return result;
  }

  Session& session(std::uint64_t id) {
    Session& found = sessions_[id];
    found.id = id;
    return found;
  }

  RecordedRun& run(std::uint64_t id, std::uint32_t number) {
    RecordedRun& found = session(id).runs[number];
    found.number = number;
    return found;
  }

  void add(const dmf_sim::Scene& message) {
    Session& scene = session(message.session);
    scene.scene = message.name;
    scene.version = message.version;
    scene.seed = message.seed;
    scene.kernel = message.kernel;
    scene.hash_interval = message.hash_interval;
    scene.fingerprint = number_of(message.fingerprint);
    scene.files.clear();
    for (const dmf_sim::SceneFile& file : message.files)
      scene.files.push_back({file.role, file.path, file.text});
  }

  void add(const dmf_sim::Command& message) {
    heard_.emplace_back(&run(message.session, message.run), message);
  }

  void add(const dmf_sim::RunRecord& message) {
    RecordedRun& found = run(message.session, message.run);
    found.seed = message.seed;
    for (const dmf_sim::Command& command : message.commands)
      found.commands[command.index] = {command.step, command.name, command.json};
    for (const dmf_sim::StateHash& hash : message.hashes) {
      chip::StateRecord& record = found.hashes[hash.index];
      record.index = hash.index;
      record.step = hash.step;
      record.commands = hash.commands;
      record.hash = number_of(hash.hash);
      record.chain = number_of(hash.chain);
    }
  }

  void add(const dmf_sim::CheckpointFile& message) {
    RecordedCheckpoint checkpoint{message.step, message.name, {message.data.begin(), message.data.end()}};
    run(message.session, message.run).checkpoints.emplace(message.step, std::move(checkpoint));
  }

  BagRecord& record_;
  std::string chip_;
  std::size_t count_ = 0;
  std::map<std::uint64_t, Session> sessions_;
  std::vector<std::pair<RecordedRun*, dmf_sim::Command>> heard_;  ///< on ~commands
  std::vector<boost::shared_ptr<dmf_sim::Event>> events_;
};

}  // namespace

BagRecord read_bag(const std::string& path, const std::string& chip) {
  BagRecord record;
  record.path = path;
  rosbag::Bag bag;
  open(bag, path);
  Reader reader(record, chip);
  try {
    rosbag::View all(bag);
    if (all.size() > 0) record.duration = (all.getEndTime() - all.getBeginTime()).toSec();
    rosbag::View view(bag, rosbag::TopicQuery(reader.topics()));
    for (const rosbag::MessageInstance& message : view) reader.take(message);
  } catch (const ros::Exception& error) {  // rosbag's own, and those of messages that end early
    throw InvalidInput(fmt::format("{}: is damaged: {}", path, error.what()));
  }
  reader.finish();
  return record;
}

}  // namespace dmf::bag_tools
