#include "chip/checkpoint_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "chip/experiment.h"
#include "engine/saved_state.h"

namespace dmf::chip {

namespace {

using engine::InvalidInput;

constexpr const char* kMagic = "dmf_sim checkpoint ";
constexpr int kVersion = 2;
constexpr const char* kTemporary = ".unfinished";
constexpr std::size_t kMaxNameLength = 100;
constexpr std::size_t kMaxHeaderLength = 1 << 16;
/// ros::Time has 32 bits for seconds, ns.
constexpr std::uint64_t kMaxRosTime = 4'000'000'000'000'000'000;
constexpr std::size_t kTrailerLength = sizeof("crc64 0123456789abcdef\n") - 1;

/// A file descriptor that closes itself.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int get() const { return descriptor_; }
  bool valid() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

[[noreturn]] void fail(const std::string& what, const std::string& file) {
  throw std::runtime_error(fmt::format("{} {}: {}", what, file, std::strerror(errno)));
}

void check_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  };
  if (name.empty() || name.size() > kMaxNameLength || name.front() == '.' ||
      !std::all_of(name.begin(), name.end(), allowed)) {
    throw InvalidInput(
        fmt::format("path: \"{}\", allowed: a bare file name of 1 to {} letters, digits, '.', '_' and '-', "
                    "not starting with '.'",
                    name, kMaxNameLength));
  }
}

/// CRC-64 of ECMA-182, bit-reflected (as in xz).
std::uint64_t crc64(const char* data, std::size_t size) {
  static const auto table = [] {
    std::array<std::uint64_t, 256> entries{};
    for (std::uint64_t i = 0; i < 256; ++i) {
      std::uint64_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ (value & 1 ? 0xC96C5795D7870F42u : 0);
      entries[i] = value;
    }
    return entries;
  }();
  std::uint64_t crc = ~std::uint64_t{0};
  for (std::size_t i = 0; i < size; ++i) {
    crc = table[(crc ^ static_cast<unsigned char>(data[i])) & 0xff] ^ (crc >> 8);
  }
  return ~crc;
}

std::string trailer(const char* data, std::size_t size) {
  return fmt::format("crc64 {:016x}\n", crc64(data, size));
}

void write_all(int descriptor, const std::string& data, const std::string& file) {
  std::size_t done = 0;
  while (done < data.size()) {
    const ssize_t n = ::write(descriptor, data.data() + done, data.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("can't write", file);
    done += static_cast<std::size_t>(n);
  }
}

std::string read_all(int descriptor, std::size_t size, const std::string& file) {
  std::string data(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t n = ::read(descriptor, data.data() + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("can't read", file);
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  data.resize(done);
  return data;
}

bool is_temporary(const std::string& name) {
  const std::size_t end = std::strlen(kTemporary);
  return name.size() > end && name.compare(name.size() - end, end, kTemporary) == 0;
}

/// What lies at `name` in an open folder: nothing, a regular file, or something that must not be touched.
enum class Entry { none, file, other };
Entry entry(const File& folder, const std::string& name) {
  struct stat status {};
  if (::fstatat(folder.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return Entry::none;
  return S_ISREG(status.st_mode) ? Entry::file : Entry::other;
}

}  // namespace

std::string encode(const Checkpoint& checkpoint) {
  const nlohmann::json header = {{"package_version", DMF_VERSION},
                                 {"scene", checkpoint.scene},
                                 {"scene_hash", checkpoint.scene_hash},
                                 {"seed", checkpoint.seed},
                                 {"step", checkpoint.step},
                                 {"time", checkpoint.time},
                                 {"state_hash", checkpoint.state_hash},
                                 {"ros_time", checkpoint.ros_time},
                                 {"run", checkpoint.run},
                                 {"paused", checkpoint.paused},
                                 {"state_bytes", checkpoint.state.size()}};
  std::string data = fmt::format("{}{}\n{}\n", kMagic, kVersion, header.dump());
  data += checkpoint.state;
  data += trailer(data.data(), data.size());
  return data;
}

Checkpoint decode(const std::string& data, const std::string& name) {
  const auto refuse = [&name](const std::string& why) {
    throw InvalidInput(fmt::format("checkpoint \"{}\": {}", name, why));
  };
  if (data.compare(0, std::strlen(kMagic), kMagic) != 0) refuse("this is not a checkpoint of dmf_sim");
  const std::size_t magic_end = data.find('\n');
  const std::size_t header_end =
      magic_end == std::string::npos ? std::string::npos : data.find('\n', magic_end + 1);
  if (header_end == std::string::npos || header_end > kMaxHeaderLength) refuse("the file is cut off");
  const std::string version = data.substr(std::strlen(kMagic), magic_end - std::strlen(kMagic));
  if (version != std::to_string(kVersion)) {
    refuse(fmt::format("version {}, allowed: {}", version, kVersion));
  }
  if (data.size() < header_end + 1 + kTrailerLength) refuse("the file is cut off");
  const std::size_t body = data.size() - kTrailerLength;
  if (data.compare(body, kTrailerLength, trailer(data.data(), body)) != 0) {
    refuse("the checksum does not match, the file is damaged or cut off");
  }
  Checkpoint checkpoint;
  try {
    const auto header = nlohmann::json::parse(data.begin() + static_cast<std::ptrdiff_t>(magic_end) + 1,
                                              data.begin() + static_cast<std::ptrdiff_t>(header_end));
    const auto number = [&](const char* key, std::uint64_t most) {
      const nlohmann::json& value = header.at(key);
      if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
        refuse(fmt::format("bad header: {}: {}, allowed: 0 to {}", key, value.dump(), most));
      return value.get<std::uint64_t>();
    };
    constexpr std::uint64_t kAny = ~std::uint64_t{0};
    checkpoint.package_version = header.at("package_version").get<std::string>();
    checkpoint.scene = header.at("scene").get<std::string>();
    checkpoint.scene_hash = number("scene_hash", kAny);
    checkpoint.seed = number("seed", kAny);
    checkpoint.step = number("step", engine::most_steps);
    checkpoint.time = header.at("time").get<double>();
    checkpoint.state_hash = number("state_hash", kAny);
    checkpoint.ros_time = number("ros_time", kMaxRosTime);
    checkpoint.run = static_cast<std::uint32_t>(number("run", std::numeric_limits<std::uint32_t>::max() - 1));
    checkpoint.paused = header.at("paused").get<bool>();
    if (number("state_bytes", kAny) != body - header_end - 1)
      refuse("the state has not the size that its header says");
    checkpoint.state = data.substr(header_end + 1, body - header_end - 1);
  } catch (const nlohmann::json::exception& error) {
    refuse(fmt::format("bad header: {}", error.what()));
  }
  return checkpoint;
}

Checkpoint checkpoint_of(const Experiment& experiment) {
  const auto snapshot = experiment.observe({false, true});
  Checkpoint checkpoint;
  checkpoint.scene = experiment.scene().name;
  checkpoint.scene_hash = experiment.scene_hash();
  checkpoint.seed = experiment.simulation().parameters().seed;
  checkpoint.step = snapshot->step;
  checkpoint.time = snapshot->time;
  checkpoint.state_hash = snapshot->state_hash.value();
  checkpoint.state = experiment.save();
  return checkpoint;
}

void CheckpointFolder::write(const std::string& name, const Checkpoint& checkpoint) const {
  check_name(name);
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw std::runtime_error(fmt::format("can't create {}: {}", folder_.string(), error.message()));
  const File folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.valid()) fail("can't open", folder_.string());
  if (entry(folder, name) == Entry::other) {
    throw InvalidInput(
        fmt::format("path: \"{}\" is there and is no regular file, allowed: a new name or a checkpoint "
                    "that may be replaced",
                    name));
  }

  // Names of temporaries start with a dot, which no checkpoint's does, and are used once.
  static std::atomic<unsigned> count{0};
  const std::string temporary = fmt::format(".{}.{}.{}{}", name, ::getpid(), count++, kTemporary);
  const std::string shown = (folder_ / name).string();
  try {
    const File file(::openat(folder.get(), temporary.c_str(),
                             O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                             S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH));
    if (!file.valid()) fail("can't create", shown);
    write_all(file.get(), encode(checkpoint), shown);
    if (::fsync(file.get()) != 0) fail("can't flush", shown);
    if (::renameat(folder.get(), temporary.c_str(), folder.get(), name.c_str()) != 0)
      fail("can't rename", shown);
    if (::fsync(folder.get()) != 0) fail("can't flush", folder_.string());
  } catch (...) {
    ::unlinkat(folder.get(), temporary.c_str(), 0);
    throw;
  }
}

Checkpoint CheckpointFolder::read(const std::string& name) const {
  check_name(name);
  const auto missing = [&] {
    const auto there = names();
    throw InvalidInput(fmt::format(
        "path: \"{}\" is not in {}, allowed: {}", name, folder_.string(),
        there.empty() ? "nothing, there is no checkpoint yet" : fmt::format("{}", fmt::join(there, ", "))));
  };
  const File folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.valid()) missing();
  // O_NONBLOCK: opening a pipe must not wait for its other end.
  const File file(::openat(folder.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (!file.valid() || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) missing();
  return decode(read_all(file.get(), static_cast<std::size_t>(status.st_size), (folder_ / name).string()),
                name);
}

std::vector<std::string> CheckpointFolder::names() const {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder_, error)) {
    const std::string name = file.path().filename().string();
    if (!file.is_symlink(error) && file.is_regular_file(error) && name.front() != '.') found.push_back(name);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void CheckpointFolder::remove(const std::string& name) const {
  check_name(name);
  const File folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.valid() && entry(folder, name) == Entry::file) ::unlinkat(folder.get(), name.c_str(), 0);
}

void CheckpointFolder::remove_leftovers(const std::string& prefix) const {
  std::vector<std::filesystem::path> found;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder_, error)) {
    const std::string name = file.path().filename().string();
    if (name.rfind("." + prefix, 0) == 0 && is_temporary(name)) found.push_back(file.path());
  }
  for (const auto& file : found) ::unlink(file.c_str());
}

}  // namespace dmf::chip
