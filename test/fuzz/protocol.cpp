// A protocol of the controller, on a board of three by three pads.
#include "controller/protocol.h"
#include "../controller/fake_board.h"
#include "target.h"
#include "yaml/invalid_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dmf;
  static const controller::Layout layout(controller::grid_board(3, 3));
  try {
    const auto protocol = controller::parse_protocol(text_of(data, size), "fuzz.yaml", layout, 80);
    require(!protocol.steps.empty(), "an accepted protocol has steps");
    for (const auto& step : protocol.steps)
      require(!step.voltage || (*step.voltage > 0 && *step.voltage <= 80),
              "no step asks for more than the board has");
  } catch (const InvalidInput&) {
  }
  return 0;
}
