#pragma once
namespace dmf::controller {

/// Tells when a neck of liquid has broken. A board sees it get thinner, and nothing of the moment. It may
/// rest on the way: liquid flows out of it slowly, and a neck as wide as the plates are apart still carries a
/// droplet back through it when one end lets go. Once it has broken its stumps are drawn into the droplets,
/// and the electrode under it is dry. So that is what is waited for.
class Neck {
 public:
  /// Less of an electrode is wetted by what bulges onto it from the electrodes beside it, if the droplets
  /// there are not larger than one and a half electrodes; a neck that narrow is about to break by itself.
  static constexpr double kDry = 0.15;

  /// @param wetted  fraction of the electrode under it. @param quiet  s that it has to stay dry.
  bool has_broken(double wetted, double time, double quiet) {
    if (wetted >= kDry || dry_since_ < 0) dry_since_ = time;
    return wetted < kDry && time - dry_since_ >= quiet;
  }

 private:
  double dry_since_ = -1;  ///< s, or later; below 0: nothing was seen yet
};

/// For how long liquid has to stay as it is wanted, of what a step may take: one reading is noise, and
/// droplets quiver.
constexpr double kQuiet = 0.1;

}  // namespace dmf::controller
