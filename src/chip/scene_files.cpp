#include "chip/scene_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/parameters.h"

namespace dmf::chip {

SceneFiles SceneFiles::recorded(std::vector<SceneFile> files) {
  SceneFiles result;
  result.files_ = std::move(files);
  result.recorded_ = true;
  return result;
}

const SceneFile* SceneFiles::look_up(const std::string& role) const {
  const auto found = std::find_if(files_.begin(), files_.end(),
                                  [&role](const SceneFile& file) { return file.role == role; });
  return found == files_.end() ? nullptr : &*found;
}

SceneFile SceneFiles::get(const std::string& role, const Find& find, Read& read) const {
  if (const SceneFile* here = look_up(role)) return *here;
  if (recorded_) throw engine::InvalidInput(fmt::format("the record of the scene lacks its {} file", role));
  const std::string path = find();
  return {role, path, read(path)};
}

const SceneFile& SceneFiles::keep(const std::string& role, const Find& find, Read& read) {
  if (const SceneFile* here = look_up(role)) return *here;
  files_.push_back(get(role, find, read));
  return files_.back();
}

}  // namespace dmf::chip
