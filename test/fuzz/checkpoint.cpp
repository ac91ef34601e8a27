// A checkpoint, and the saved run in it. The input is a list of edits to a good one, so that it stays good
// when the format changes: five bytes each, where (a big-endian number, taken modulo the length) and what
// stands there then. The first byte chooses what is edited: a saved run with (0) or without (1)
// microparticles, a checkpoint file with a wrong checksum (2) or one that is made right again (3). An edit's
// place of 0xffffffff cuts everything behind off.
#include <unistd.h>

#include <boost/crc.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "chip/checkpoint_file.h"
#include "chip/experiment.h"
#include "target.h"

namespace {

namespace fs = std::filesystem;
using namespace dmf;

chip::Scene small_scene(const std::string& rest) {
  return chip::parse_scene(
      "domain: {lower: [-5, -4, 0], upper: [5, 4, 8]}\n"
      "observe_interval: 5\n"
      "chip: {gap: 1, grids: [{origin: [-2, 0], columns: 2, rows: 1, pitch: 4}], electrowetting: "
      "{charging_time: 1}}\n"
      "droplets: [{center: [-2, 0], radius: 1.8}]\n"
      "patterns: {blink: [{at: 0, set_electrodes: {channels: [0]}}, {at: 0.1, set_electrodes: {channels: "
      "[1]}}]}\n" +
          rest,
      "fuzz.yaml");
}

/// A run that is saved, and the experiment that loads what becomes of it.
struct Good {
  explicit Good(const std::string& rest) : scene(small_scene(rest)) {
    make_experiment();
    experiment->apply(chip::SetHv{60, 1000, true});
    experiment->apply(chip::LoadPattern{"blink"});
    for (int k = 0; k < 12; ++k) experiment->step();
    run = experiment->save();
    hash = hash_now();
  }
  void make_experiment() {
    experiment = std::make_unique<chip::Experiment>(scene, engine::Execution{1, "auto"});
  }
  std::uint64_t hash_now() const { return *experiment->observe({false, true})->state_hash; }

  chip::Scene scene;
  std::unique_ptr<chip::Experiment> experiment;
  std::string run;
  std::uint64_t hash = 0;
};

std::string edited(std::string bytes, const std::uint8_t* edits, std::size_t size) {
  for (std::size_t k = 0; k + 5 <= size && !bytes.empty(); k += 5) {
    const std::uint32_t where = std::uint32_t{edits[k]} << 24 | std::uint32_t{edits[k + 1]} << 16 |
                                std::uint32_t{edits[k + 2]} << 8 | edits[k + 3];
    if (where == 0xffffffffu)
      bytes.resize(bytes.size() * edits[k + 4] / 256);
    else
      bytes[where % bytes.size()] = static_cast<char>(edits[k + 4]);
  }
  return bytes;
}

void load(Good& good, const std::string& run) {
  try {
    good.experiment->load(run);
  } catch (const InvalidInput&) {
    require(good.hash_now() == good.hash, "a refused state changes nothing");
    return;
  }
  // A number that was changed may blow the run up, but in an orderly way.
  try {
    for (int k = 0; k < 11; ++k) good.experiment->step();
    good.experiment->observe({true, true});
    good.experiment->sense();
    require(!good.experiment->save().empty(), "a loaded run can be saved");
  } catch (const engine::Instability&) {
    good.make_experiment();
  }
  good.experiment->load(good.run);
  require(good.hash_now() == good.hash, "a good state is the same whatever was there before");
}

/// CRC-64 of ECMA-182, reflected, as checkpoint_file.cpp has it; from Boost.
std::string signed_anew(std::string file) {
  const std::size_t trailer = sizeof("crc64 0123456789abcdef\n") - 1;
  if (file.size() < trailer) return file;
  file.resize(file.size() - trailer);
  boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0xffffffffffffffff, 0xffffffffffffffff, true, true> crc;
  crc.process_bytes(file.data(), file.size());
  char text[32];
  std::snprintf(text, sizeof text, "crc64 %016llx\n", static_cast<unsigned long long>(crc.checksum()));
  return file + text;
}

class Folder {
 public:
  Folder() {
    const fs::path root = fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
    std::string name = (root / "dmf_fuzz_XXXXXX").string();
    require(::mkdtemp(name.data()) != nullptr, "there is a temporary folder");
    path = name;
  }
  ~Folder() { fs::remove_all(path); }
  fs::path path;
};

void read_file(const std::uint8_t* edits, std::size_t size, bool sign) {
  static const Folder folder;
  static const chip::CheckpointFolder checkpoints(folder.path);
  static const std::string good = [] {
    chip::Checkpoint checkpoint;
    checkpoint.scene = "fuzz";
    checkpoint.state = "the state";
    checkpoints.write("good", checkpoint);
    std::ifstream file(folder.path / "good", std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }();
  require(signed_anew(good) == good, "Boost's checksum is that of the file");
  const std::string bad = edited(good, edits, size);
  std::ofstream(folder.path / "edited", std::ios::binary) << (sign ? signed_anew(bad) : bad);
  try {
    checkpoints.read("edited");
    require(sign || bad == good, "a file that was changed is refused");
  } catch (const InvalidInput&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static Good liquid("");
  static Good with_particle("microparticles: [{center: [2.5, 1.5], radius: 0.5, magnetic: true}]\n");
  const std::uint8_t what = data[0] % 4;
  if (what >= 2) {
    read_file(data + 1, size - 1, what == 3);
  } else {
    Good& good = what == 0 ? with_particle : liquid;
    load(good, edited(good.run, data + 1, size - 1));
  }
  return 0;
}
