#pragma once
#include <yaml-cpp/yaml.h>

#include <string>

namespace dmf {

/// The one document of a YAML text; null when there are several. YAML::LoadAll would read for ever, and take
/// all memory, where something stands behind the document that the parser neither understands nor passes
/// over, such as a comma (yaml-cpp 0.7, github.com/jbeder/yaml-cpp/pull/1319).
/// @throws YAML::Exception when it is not YAML.
YAML::Node load_document(const std::string& text);

}  // namespace dmf
