#include "node/options.h"

#include <XmlRpcValue.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <vector>

namespace dmf::node {

namespace {

/// Reads the parameters one by one and keeps a list of what is wrong with them.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& handle) : name_(handle.getNamespace()) {
    if (!handle.getParam("", given_) || given_.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
      given_ = XmlRpc::XmlRpcValue();  // no parameter at all
    }
  }

  void number(const std::string& key, double low, double high, double& result) {
    if (const auto value = find(key)) {
      double number = std::numeric_limits<double>::quiet_NaN();
      if (value->getType() == XmlRpc::XmlRpcValue::TypeDouble) number = static_cast<double>(*value);
      if (value->getType() == XmlRpc::XmlRpcValue::TypeInt) number = static_cast<int>(*value);
      if (number >= low && number <= high) {
        result = number;
      } else {
        refuse(key, *value, fmt::format("a number from {} to {}", low, high));
      }
    }
  }

  void integer(const std::string& key, int low, int high, int& result) {
    if (const auto value = find(key)) {
      const bool good = value->getType() == XmlRpc::XmlRpcValue::TypeInt && static_cast<int>(*value) >= low &&
                        static_cast<int>(*value) <= high;
      if (good) {
        result = static_cast<int>(*value);
      } else {
        refuse(key, *value, fmt::format("a whole number from {} to {}", low, high));
      }
    }
  }

  void flag(const std::string& key, bool& result) {
    if (const auto value = find(key)) {
      if (value->getType() == XmlRpc::XmlRpcValue::TypeBoolean) {
        result = static_cast<bool>(*value);
      } else {
        refuse(key, *value, "true or false");
      }
    }
  }

  void text(const std::string& key, std::string& result) {
    if (const auto value = find(key)) {
      if (value->getType() == XmlRpc::XmlRpcValue::TypeString && !static_cast<std::string>(*value).empty()) {
        result = static_cast<std::string>(*value);
      } else {
        refuse(key, *value, "text that is not empty");
      }
    }
  }

  /// Launch files leave a seed that is not given empty; numbers beyond 2^31 come as text, XML-RPC has no
  /// larger ones.
  void seed(const std::string& key, std::optional<std::uint64_t>& result) {
    if (const auto value = find(key)) {
      if (value->getType() == XmlRpc::XmlRpcValue::TypeInt && static_cast<int>(*value) >= 0) {
        result = static_cast<std::uint64_t>(static_cast<int>(*value));
        return;
      }
      if (value->getType() == XmlRpc::XmlRpcValue::TypeString) {
        const auto text = static_cast<std::string>(*value);
        if (text.empty()) return;
        char* end = nullptr;
        errno = 0;
        const auto number = std::strtoull(text.c_str(), &end, 10);
        if (std::isdigit(static_cast<unsigned char>(text.front())) && *end == '\0' && errno == 0) {
          result = number;
          return;
        }
      }
      refuse(key, *value, "a whole number from 0 to 18446744073709551615");
    }
  }

  /// @throws engine::InvalidInput when anything was wrong or a parameter was given that nobody read.
  void finish() {
    if (given_.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
      for (auto& entry : given_) {
        if (known_.count(entry.first) == 0) {
          // It stays on the master between runs, so say how to get rid of it.
          violations_.push_back(
              fmt::format("~{} is no parameter of this node, allowed: {} (rosparam delete {}/{})",
                          entry.first, fmt::join(known_, ", "), name_, entry.first));
        }
      }
    }
    if (!violations_.empty()) throw engine::InvalidInput(fmt::format("{}", fmt::join(violations_, "; ")));
  }

 private:
  std::optional<XmlRpc::XmlRpcValue> find(const std::string& key) {
    known_.insert(key);
    if (given_.getType() != XmlRpc::XmlRpcValue::TypeStruct || !given_.hasMember(key)) return {};
    return given_[key];
  }

  void refuse(const std::string& key, const XmlRpc::XmlRpcValue& value, const std::string& allowed) {
    violations_.push_back(fmt::format("~{}: {}, allowed: {}", key, value.toXml(), allowed));
  }

  std::string name_;
  XmlRpc::XmlRpcValue given_;
  std::set<std::string> known_;
  std::vector<std::string> violations_;
};

std::string default_checkpoint_dir() {
  if (const char* ros_home = std::getenv("ROS_HOME")) return std::string(ros_home) + "/dmf_sim";
  const char* home = std::getenv("HOME");
  return std::string(home ? home : ".") + "/.ros/dmf_sim";
}

}  // namespace

Options load_options(const ros::NodeHandle& private_handle) {
  Options options;
  Reader reader(private_handle);
  reader.text("scene", options.scene);
  reader.seed("seed", options.seed);
  reader.integer("threads", 0, 256, options.execution.threads);
  reader.text("kernel", options.execution.kernel);
  reader.flag("paused", options.engine.paused);
  reader.number("publish_rate", 0.1, 1000, options.engine.publish_rate);
  reader.number("display_rate", 0.1, 1000, options.engine.display_rate);
  reader.number("max_steps_per_second", 0, 1e9, options.engine.max_steps_per_second);
  reader.number("ros_seconds_per_time_unit", 1e-6, 1e3, options.engine.ros_seconds_per_time_unit);
  reader.number("display_scale", 1, 1e6, options.display_scale);
  std::string checkpoint_dir = default_checkpoint_dir();
  reader.text("checkpoint_dir", checkpoint_dir);
  options.checkpoint_dir = checkpoint_dir;
  reader.finish();
  return options;
}

}  // namespace dmf::node
