#include "controller_node/options.h"

#include "node/parameter_reader.h"

namespace dmf::controller_node {

Options load_options(const ros::NodeHandle& private_handle) {
  Options options;
  node::ParameterReader reader(private_handle);
  int retries = static_cast<int>(options.limits.retries);
  reader.text("chip", options.chip);
  reader.number("wetted_fraction", 0.01, 0.99, options.wetted_fraction);
  reader.number("voltage", 0, 1e4, options.voltage);
  reader.number("frequency", 0, 100e3, options.frequency);
  reader.number("success_threshold", 0.01, 1, options.limits.success_threshold);
  reader.number("step_timeout", 1e-3, 1e6, options.limits.step_timeout);
  reader.integer("retries", 0, 100, retries);
  reader.text("protocol_dir", options.protocol_dir);
  reader.finish();
  options.limits.retries = static_cast<unsigned>(retries);
  return options;
}

}  // namespace dmf::controller_node
