// dmf_run SCENE: a scene without ROS.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "engine/simulation.h"
#include "engine/wait_policy.h"
#include "tools/explain.h"
#include "tools/headless_run.h"

namespace {

constexpr int kTryAgain = 75;  // EX_TEMPFAIL of sysexits.h
/// Exit status of a run that the watchdog stopped; what was asked for wrongly ends with 1.
constexpr int kStoppedByFault = 3;

/// A word of a command line as a shell takes it.
std::string quoted(const std::string& word) {
  if (!word.empty() && word.find_first_of(" \t\n'\"\\$&;|<>()*?[]#~`!{}") == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// The command line of an interrupted run, with --resume. @returns the exit status.
int tell_how_to_go_on(const dmf::tools::RunResult& result, const dmf::tools::RunOptions& options, int argc,
                      char** argv) {
  const char* signal = result.interrupted_by == SIGTERM ? "SIGTERM" : "SIGINT";
  if (options.output.empty()) {
    fmt::print(stderr, "dmf_run: {} at step {}; nothing is saved without --out\n", signal, result.steps);
    return 128 + result.interrupted_by;
  }
  std::string again;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--resume") ++i;
    if (word.rfind("--resume", 0) != 0) again += quoted(word) + " ";
  }
  fmt::print(stderr, "dmf_run: {} at step {}, saved; to go on: {}--resume {}\n", signal, result.steps, again,
             quoted(options.output));
  return kTryAgain;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace dmf;
  engine::prefer_short_spinning(argv);
  CLI::App app("Runs a scene of dmf_sim without ROS, by the scene's own schedule.");
  tools::RunOptions options;
  bool explain_only = false, hash = false;
  double resolution = 10;
  std::string file_unit;
  app.add_option("scene", options.scene, "name in config/scenes, or a file; with --explain a board file too")
      ->required();
  auto* steps = app.add_option("--steps", options.steps, "steps in all, from the scene's start");
  app.add_option("--until", options.until, "time to run to, tau")
      ->excludes(steps)
      ->check(CLI::NonNegativeNumber);
  app.add_option("--threads", options.threads, "0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "instead of the scene's");
  app.add_option("--kernel", options.kernel,
                 "auto, " + fmt::format("{}", fmt::join(engine::available_kernels(), ", ")))
      ->capture_default_str();
  auto* output =
      app.add_option("--out", options.output, "folder for tables (droplets.csv, ...) and checkpoints");
  app.add_option("--checkpoint-every", options.checkpoint_every, "steps between checkpoints in --out")
      ->needs(output);
  app.add_option("--checkpoint-period", options.checkpoint_period,
                 "seconds of wall time between checkpoints in --out")
      ->check(CLI::NonNegativeNumber)
      ->needs(output);
  app.add_option("--checkpoint-keep", options.checkpoint_keep, "how many of them stay, 0: all")
      ->capture_default_str()
      ->needs(output);
  app.add_option(
         "--resume", options.resume,
         "go on from the newest good checkpoint of this folder; with the same --out its tables end as "
         "if the run had never stopped")
      ->check(CLI::ExistingDirectory);
  auto* explain_flag =
      app.add_flag("--explain", explain_only,
                   "print what would be simulated, and stop; also of a board file (.json, .svg)");
  auto* of_board = app.add_option("--resolution", resolution, "with --explain of a board file: r_c per pitch")
                       ->needs(explain_flag)
                       ->capture_default_str();
  app.add_option("--file-unit", file_unit,
                 "with --explain of a board file: what one unit of it is, such as \"1 mm\"")
      ->needs(explain_flag);
  app.add_flag("--hash", hash, "print the hash of the final state");
  app.add_flag("--json", options.json, "the last line is one JSON object");
  app.add_flag("--quiet", options.quiet, "no progress line");
  app.footer(
      "SIGINT (Ctrl-C) and SIGTERM end a run after the step it is in, with a checkpoint in --out if there is "
      "one.\nExit status: 0 done, 75 ended by such a signal with a checkpoint to --resume from, 128 + the "
      "signal\nwithout one, 1 an error, above 100 bad options.");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is a write that fails, not the end of the run
  try {
    const bool is_board = chip::is_board_file(options.scene);
    if (is_board && !explain_only) {
      throw engine::InvalidInput(
          options.scene + ": is a board and no scene, allowed: with --explain, or a scene with chip.file");
    }
    if (!is_board && (of_board->count() > 0 || !file_unit.empty())) {
      throw engine::InvalidInput(
          "--resolution, --file-unit: allowed with a board file (.json, .svg); a scene says "
          "chip.resolution itself");
    }
    if (explain_only) {
      fmt::print("{}", tools::explain(is_board ? chip::load_board(options.scene, resolution, file_unit)
                                               : chip::load_scene(options.scene)));
      return 0;
    }
    const tools::RunResult result = tools::headless_run(options);
    if (hash) fmt::print("{:016x}\n", result.hash);
    if (options.json)
      fmt::print("{}\n", tools::to_json(result));
    else
      fmt::print(
          "{}: {} beads, {} steps (time {:.6g}) in {:.2f} s, {:.0f} ns per bead-step ({}, {} threads), "
          "temperature {:.4f}\n",
          result.scene, result.beads, result.steps, result.time, result.wall_s, result.ns_per_bead_step,
          result.kernel, result.threads, result.temperature);
    if (result.interrupted_by != 0) return tell_how_to_go_on(result, options, argc, argv);
  } catch (const engine::Instability& fault) {
    fmt::print(stderr, "dmf_run: the run was stopped: {}\n", fault.what());
    return kStoppedByFault;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "dmf_run: {}\n", problem.what());
    return 1;
  }
  return 0;
}
