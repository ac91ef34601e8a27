#pragma once
#include <XmlRpcValue.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dmf::node {

/// Reads a node's private parameters one by one and keeps a list of what is wrong with them. What is not
/// given leaves the result as it is.
class ParameterReader {
 public:
  explicit ParameterReader(const ros::NodeHandle& private_handle);

  void number(const std::string& key, double low, double high, double& result);
  void integer(const std::string& key, int low, int high, int& result);
  void flag(const std::string& key, bool& result);
  void text(const std::string& key, std::string& result);
  /// One of these words; true and false may be given as such.
  void choice(const std::string& key, const std::vector<std::string>& words, std::string& result);
  /// Launch files leave a seed that is not given empty; numbers beyond 2^31 come as text, XML-RPC has no
  /// larger ones.
  void seed(const std::string& key, std::optional<std::uint64_t>& result);

  /// @throws InvalidInput when anything was wrong or a parameter was given that nobody read, on one line.
  void finish();

 private:
  std::optional<XmlRpc::XmlRpcValue> find(const std::string& key);
  void refuse(const std::string& key, const XmlRpc::XmlRpcValue& value, const std::string& allowed);

  std::string name_;
  XmlRpc::XmlRpcValue given_;
  std::set<std::string> known_;
  std::vector<std::string> violations_;
};

}  // namespace dmf::node
