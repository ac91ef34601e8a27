#pragma once
#include <memory>

#include "controller/operation.h"

/// One factory a kind of goal; make_operation() picks.
namespace dmf::controller {

std::unique_ptr<Operation> make_move(const Move& goal, Traffic::Key key, View& view);
std::unique_ptr<Operation> make_mix(const Mix& goal, Traffic::Key key, View& view);
std::unique_ptr<Operation> make_merge(const Merge& goal, Traffic::Key key, View& view);
std::unique_ptr<Operation> make_split(const Split& goal, Traffic::Key key, View& view);
std::unique_ptr<Operation> make_dispense(const Dispense& goal, Traffic::Key key, View& view);

}  // namespace dmf::controller
