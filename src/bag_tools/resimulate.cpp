// resimulate BAG: computes what a bag has recorded again, and says whether it is the same.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>

#include "bag_tools/bag_record.h"
#include "bag_tools/report.h"
#include "bag_tools/resimulation.h"
#include "chip/scene.h"
#include "engine/simulation.h"
#include "engine/wait_policy.h"
#include "tools/progress.h"
#include "yaml/quantity.h"

namespace {

using namespace dmf;
using namespace dmf::bag_tools;

struct Arguments {
  std::string bag, chip = "/chip";
  std::optional<std::uint32_t> run;
  std::optional<std::size_t> session;
  std::string from, until;
  ResimulationOptions options;
  bool info = false, commands = false, quiet = false;
};

/// A step as it is, or a time with a unit.
std::uint64_t step_of(const std::string& option, const std::string& text, const Session& session) {
  const chip::Scene scene = chip::rebuild_scene(session.files);
  const auto time = parse_quantity(text, Dimension::time);
  const double step = !time        ? -1
                      : time->bare ? time->value
                                   : time->value / scene.units.time_s / scene.parameters.time_step;
  if (!(step >= 0 && step < 1e18) || (time->bare && step != std::floor(step)))
    throw InvalidInput(
        fmt::format("{}: {}, allowed: a step, or a time with a unit such as \"2.5 ms\"", option, text));
  return static_cast<std::uint64_t>(std::llround(step));
}

bool resimulate(const Session& session, const RecordedRun& run, const Arguments& arguments) {
  ResimulationOptions options = arguments.options;
  if (!arguments.from.empty()) options.from = step_of("--from", arguments.from, session);
  if (!arguments.until.empty()) options.until = step_of("--until", arguments.until, session);
  std::optional<tools::Progress> progress;
  const Verdict verdict =
      resimulate(session, run, options, [&](std::uint64_t step, std::uint64_t from, std::uint64_t to) {
        if (!progress) progress.emplace(from, to, arguments.quiet);
        progress->show(step);
      });
  progress.reset();
  fmt::print("run {}: {}\n", run.number, verdict.message);
  fmt::print("  steps {} to {} in {:.1f} s, {:.0f} steps/s, kernel {}, {} threads\n", verdict.start,
             verdict.end, verdict.wall_s,
             static_cast<double>(verdict.end - verdict.start) / std::max(1e-9, verdict.wall_s),
             verdict.kernel, verdict.threads);
  return verdict.reproduced;
}

/// The runs that were asked for. @throws InvalidInput when there are none.
std::vector<std::pair<const Session*, const RecordedRun*>> chosen(const BagRecord& record,
                                                                  const Arguments& arguments) {
  std::vector<std::pair<const Session*, const RecordedRun*>> found;
  std::vector<std::string> there;
  for (std::size_t i = 0; i < record.sessions.size(); ++i) {
    for (const auto& [number, run] : record.sessions[i].runs) {
      there.push_back(record.sessions.size() > 1 ? fmt::format("run {} of session {}", number, i + 1)
                                                 : fmt::format("run {}", number));
      if (arguments.session && *arguments.session != i + 1) continue;
      if (arguments.run && *arguments.run != number) continue;
      found.emplace_back(&record.sessions[i], &run);
    }
  }
  if (found.empty()) {
    throw InvalidInput(
        there.empty() ? fmt::format("{}: holds neither commands nor state hashes", record.path)
                      : fmt::format("--run, --session: no such run, allowed: {}", fmt::join(there, ", ")));
  }
  if (found.size() > 1 && !(arguments.from.empty() && arguments.until.empty()))
    throw InvalidInput(
        fmt::format("--from, --until: allowed with --run, the bag holds {}", fmt::join(there, ", ")));
  return found;
}

int work(const Arguments& arguments) {
  const BagRecord record = read_bag(arguments.bag, arguments.chip);
  if (arguments.info || arguments.commands) {
    fmt::print("{}", describe(record, arguments.commands));
    bool complete = true;
    for (const Session& session : record.sessions) {
      for (const auto& [number, run] : session.runs)
        complete = complete && gaps(session, run).empty() && alterations(session, run).empty();
    }
    return complete ? 0 : 1;
  }
  bool reproduced = true;
  for (const auto& [session, run] : chosen(record, arguments)) {
    const bool other_version = !session->version.empty() && session->version != DMF_SIM_VERSION;
    if (other_version) {
      fmt::print("recorded with dmf_sim {}, this is {}: a difference may be one between the versions\n",
                 session->version, DMF_SIM_VERSION);
    }
    const std::vector<std::string> altered = alterations(*session, *run);
    for (const std::string& gap : gaps(*session, *run))
      fmt::print("run {}: incomplete: {}\n", run->number, gap);
    for (const std::string& alteration : altered)
      fmt::print("run {}: the record was altered: {}\n", run->number, alteration);
    std::fflush(stdout);
    reproduced = resimulate(*session, *run, arguments) && altered.empty() && reproduced;
  }
  return reproduced ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  engine::prefer_short_spinning(argv);
  CLI::App app(
      "Computes the runs that a bag of dmf_sim holds again, from the bag alone, and compares every state "
      "hash. "
      "Exit status 0: all are equal, and nothing in the bag was altered.");
  Arguments arguments;
  app.add_option("bag", arguments.bag,
                 "recorded with chip.launch record:=true, or any with the chip's topics")
      ->required();
  app.add_option("--run", arguments.run, "only this one, by the number of ~state; default: each");
  app.add_option("--session", arguments.session, "of a node that was restarted: its first start is 1");
  app.add_option("--from", arguments.from,
                 "begin at the last checkpoint of the bag up to this step, or time (\"2.5 ms\")");
  app.add_option("--until", arguments.until, "last step, or time, to compare");
  app.add_option("--threads", arguments.options.threads, "0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--kernel", arguments.options.kernel,
                 "auto, " + fmt::format("{}", fmt::join(engine::available_kernels(), ", ")) +
                     "; default: what gives the recorded bits");
  app.add_option("--chip", arguments.chip, "name of the chip's node")->capture_default_str();
  app.add_flag("--info", arguments.info, "say what the bag holds, and compute nothing");
  app.add_flag("--commands", arguments.commands, "the same with every command");
  app.add_flag("--quiet", arguments.quiet, "no progress line");
  CLI11_PARSE(app, argc, argv);
  try {
    return work(arguments);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "resimulate: {}\n", problem.what());
    return 1;
  }
}
