#include "node/parameter_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <limits>

#include "yaml/invalid_input.h"

namespace dmf::node {

ParameterReader::ParameterReader(const ros::NodeHandle& private_handle)
    : name_(private_handle.getNamespace()) {
  if (!private_handle.getParam("", given_) || given_.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    given_ = XmlRpc::XmlRpcValue();  // no parameter at all
  }
}

void ParameterReader::number(const std::string& key, double low, double high, double& result) {
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

void ParameterReader::integer(const std::string& key, int low, int high, int& result) {
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

void ParameterReader::flag(const std::string& key, bool& result) {
  if (const auto value = find(key)) {
    if (value->getType() == XmlRpc::XmlRpcValue::TypeBoolean) {
      result = static_cast<bool>(*value);
    } else {
      refuse(key, *value, "true or false");
    }
  }
}

void ParameterReader::text(const std::string& key, std::string& result) {
  if (const auto value = find(key)) {
    if (value->getType() == XmlRpc::XmlRpcValue::TypeString && !static_cast<std::string>(*value).empty()) {
      result = static_cast<std::string>(*value);
    } else {
      refuse(key, *value, "text that is not empty");
    }
  }
}

void ParameterReader::choice(const std::string& key, const std::vector<std::string>& words,
                             std::string& result) {
  if (const auto value = find(key)) {
    std::string given;
    if (value->getType() == XmlRpc::XmlRpcValue::TypeString) given = static_cast<std::string>(*value);
    if (value->getType() == XmlRpc::XmlRpcValue::TypeBoolean)
      given = static_cast<bool>(*value) ? "true" : "false";
    if (std::find(words.begin(), words.end(), given) != words.end()) {
      result = given;
    } else {
      refuse(key, *value, fmt::format("{}", fmt::join(words, ", ")));
    }
  }
}

void ParameterReader::seed(const std::string& key, std::optional<std::uint64_t>& result) {
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

void ParameterReader::finish() {
  if (given_.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    for (auto& entry : given_) {
      if (known_.count(entry.first) == 0) {
        // It stays on the master between runs, so say how to get rid of it.
        violations_.push_back(
            fmt::format("~{} is no parameter of this node, allowed: {} (rosparam delete {}/{})", entry.first,
                        fmt::join(known_, ", "), name_, entry.first));
      }
    }
  }
  if (!violations_.empty()) throw InvalidInput(fmt::format("{}", fmt::join(violations_, "; ")));
}

std::optional<XmlRpc::XmlRpcValue> ParameterReader::find(const std::string& key) {
  known_.insert(key);
  if (given_.getType() != XmlRpc::XmlRpcValue::TypeStruct || !given_.hasMember(key)) return {};
  return given_[key];
}

void ParameterReader::refuse(const std::string& key, const XmlRpc::XmlRpcValue& value,
                             const std::string& allowed) {
  violations_.push_back(fmt::format("~{}: {}, allowed: {}", key, value.toXml(), allowed));
}

}  // namespace dmf::node
