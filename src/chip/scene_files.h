#pragma once
#include <functional>
#include <string>
#include <vector>

namespace dmf::chip {

/// A text that a scene was read from.
struct SceneFile {
  std::string role;  ///< what it is to the scene, one of file_role
  std::string path;  ///< where it was found; stands for it in messages, and a scene is named after its own
  std::string text;
};

/// A scene has at most one file of each, but for meshes: their role has the name that the scene gives after
/// it.
namespace file_role {
constexpr const char* kScene = "scene";
constexpr const char* kBoard = "board";
constexpr const char* kCalibration = "calibration";
constexpr const char* kMicroparticleCalibration = "microparticle_calibration";
/// A raw file; pictures are label_grid_0 and so on.
constexpr const char* kLabelGrid = "label_grid";
constexpr const char* kMesh = "mesh";
}  // namespace file_role

/// All the texts that make up a scene, so that it can be built again from them alone: where the files were
/// may be another machine, and what stood in them may have changed since.
class SceneFiles {
 public:
  /// None yet; what is needed is read from the disk.
  SceneFiles() = default;
  /// What was recorded; nothing is read from the disk.
  static SceneFiles recorded(std::vector<SceneFile> files);

  using Find = std::function<std::string()>;     ///< path of a file
  using Read = std::string(const std::string&);  ///< text of a file
  /// The text of a role: one that is here, else from the disk. @throws engine::InvalidInput when there is
  /// neither, and what `find` and `read` throw.
  SceneFile get(const std::string& role, const Find& find, Read& read) const;
  /// The same, and from now on it is here.
  const SceneFile& keep(const std::string& role, const Find& find, Read& read);
  void add(SceneFile file) { files_.push_back(std::move(file)); }

  const std::vector<SceneFile>& all() const { return files_; }
  /// The one of that role, null when it is not here.
  const SceneFile* look_up(const std::string& role) const;

 private:
  std::vector<SceneFile> files_;
  bool recorded_ = false;
};

}  // namespace dmf::chip
