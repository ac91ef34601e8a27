// A command as JSON, as ~commands and saved runs have it; then what the chip says of it.
#include "chip/command_rules.h"
#include "target.h"

namespace {

const dmf::chip::Scene& scene() {
  static const dmf::chip::Scene tiny = dmf::chip::load_scene(DMF_SOURCE_DIR "/test/scenes/tiny_line.yaml");
  return tiny;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dmf;
  static const engine::ContactAngleCurve curve = chip::load_curve(scene());
  try {
    const chip::Command command = chip::command_from_json(text_of(data, size));
    const std::string written = chip::to_json(command);
    require(chip::to_json(chip::command_from_json(written)) == written,
            "a command is read as it was written");
    chip::violations(command, scene(), curve);
  } catch (const InvalidInput&) {
  }
  return 0;
}
