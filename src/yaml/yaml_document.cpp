#include "yaml/yaml_document.h"

#include <yaml-cpp/eventhandler.h>

#include <sstream>

namespace dmf {

namespace {

/// Takes no notice of what is in a document.
class Passer : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}
};

}  // namespace

YAML::Node load_document(const std::string& text) {
  std::istringstream input(text);
  YAML::Parser parser(input);
  Passer passer;
  if (parser.HandleNextDocument(passer) && parser.HandleNextDocument(passer)) return {};
  return YAML::Load(text);
}

}  // namespace dmf
