#include "chip/checkpoint_series.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "engine/parameters.h"

namespace dmf::chip {
namespace {

constexpr std::size_t kDigits = 12;
constexpr std::uint64_t kNone = ~std::uint64_t{0};

}  // namespace

/// The kernel gives it back when the process ends.
class CheckpointSeries::Lock {
 public:
  Lock(const std::filesystem::path& folder, const std::string& prefix) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw std::runtime_error(fmt::format("can't create {}: {}", folder.string(), error.message()));
    const std::string file = (folder / ("." + prefix + "lock")).string();
    descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor_ < 0)
      throw std::runtime_error(fmt::format("can't open {}: {}", file, std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      ::close(descriptor_);
      if (reason != EWOULDBLOCK)
        throw std::runtime_error(fmt::format("can't lock {}: {}", file, std::strerror(reason)));
      throw engine::InvalidInput(
          fmt::format("{}: another process writes {}* there, allowed: one at a time; choose another folder",
                      folder.string(), prefix));
    }
  }
  ~Lock() { ::close(descriptor_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int descriptor_;
};

CheckpointSeries::CheckpointSeries(std::filesystem::path folder, std::string prefix, std::string suffix,
                                   Numbering numbering, unsigned keep)
    : folder_(std::move(folder)),
      prefix_(std::move(prefix)),
      suffix_(std::move(suffix)),
      numbering_(numbering),
      keep_(std::max(1u, keep)) {}

void CheckpointSeries::claim() {
  if (lock_) return;
  lock_ = std::make_shared<Lock>(folder_.path(), prefix_);
  folder_.remove_leftovers(prefix_);
}

std::string CheckpointSeries::write(const Checkpoint& checkpoint) {
  claim();
  const std::uint64_t number = numbering_ == Numbering::by_step ? checkpoint.step : next_number();
  folder_.write(name_of(number), checkpoint);
  std::vector<std::uint64_t> there = numbers();
  there.erase(std::upper_bound(there.begin(), there.end(), number), there.end());
  for (std::size_t k = 0; k + keep_ < there.size(); ++k) folder_.remove(name_of(there[k]));
  return name_of(number);
}

std::string CheckpointSeries::name_of(std::uint64_t number) const {
  return fmt::format("{}{:0{}}{}", prefix_, number, kDigits, suffix_);
}

std::uint64_t CheckpointSeries::number_in(const std::string& name) const {
  const std::size_t before = prefix_.size(), after = suffix_.size();
  if (name.size() < before + kDigits + after || name.size() > before + 19 + after) return kNone;
  if (name.compare(0, before, prefix_) != 0 || name.compare(name.size() - after, after, suffix_) != 0)
    return kNone;
  const std::string digits = name.substr(before, name.size() - before - after);
  if (digits.find_first_not_of("0123456789") != std::string::npos) return kNone;
  return std::stoull(digits);
}

std::vector<std::uint64_t> CheckpointSeries::numbers() const {
  std::vector<std::uint64_t> found;
  for (const std::string& name : folder_.names())
    if (const std::uint64_t number = number_in(name); number != kNone) found.push_back(number);
  std::sort(found.begin(), found.end());
  return found;
}

std::uint64_t CheckpointSeries::next_number() const {
  const std::vector<std::uint64_t> there = numbers();
  return there.empty() ? 1 : there.back() + 1;
}

std::optional<ResumePoint> resume(Experiment& experiment, const CheckpointSeries& series,
                                  const ResumeRule& rule,
                                  const std::function<void(const std::string&)>& passed_over) {
  std::vector<std::uint64_t> there = series.numbers();
  for (auto number = there.rbegin(); number != there.rend() && *number >= rule.first_number; ++number) {
    ResumePoint point;
    point.name = series.name_of(*number);
    try {
      point.checkpoint = series.folder().read(point.name);
      if (rule.seed && point.checkpoint.seed != *rule.seed) {
        throw engine::InvalidInput(fmt::format("checkpoint \"{}\": of seed {}, allowed: {}", point.name,
                                               point.checkpoint.seed, *rule.seed));
      }
      experiment.load(point.checkpoint.state);
    } catch (const std::exception& problem) {  // also what the disk or too little memory refuses
      passed_over(fmt::format("{}: passed over: {}", point.name, problem.what()));
      continue;
    }
    point.checkpoint.state = {};
    return point;
  }
  return std::nullopt;
}

}  // namespace dmf::chip
