#pragma once
namespace dmf::controller {

/// Tells when a neck of liquid has broken. A board sees it get thinner, and nothing of the moment: when an
/// electrode under it is no longer wetted and has not become drier for a while, what is left on it belongs to
/// the droplets beside it.
class Neck {
 public:
  /// @param wetted  fraction of the electrode under it. @param quiet  s without a change until it has broken.
  bool has_broken(double wetted, double threshold, double time, double quiet) {
    constexpr double kChange = 0.02;
    if (wetted < lowest_ - kChange) {
      lowest_ = wetted;
      since_ = time;
    }
    return wetted < threshold && time - since_ >= quiet;
  }

 private:
  double lowest_ = 2;  ///< beyond every fraction
  double since_ = 0;   ///< s
};

/// For how long a neck has to stay as it is, of what a step may take.
constexpr double kNeckQuiet = 0.1;

}  // namespace dmf::controller
