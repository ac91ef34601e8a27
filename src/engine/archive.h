#pragma once
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/parameters.h"

namespace dmf::engine {

/// Writes plain values into a string of bytes, or reads them back in the same order: one `archive(...)`
/// function of a class serves both ways, so that they can't drift apart. Native byte order. Whether the bytes
/// are those that were written is the caller's business (a checksum around the whole), but they are not
/// trusted: reading past the end is refused, and no count makes more room than there are bytes left. What the
/// values mean, whoever reads them has to check.
class Archive {
 public:
  /// For writing.
  Archive() : reading_(false) {}
  /// For reading.
  explicit Archive(std::string bytes) : reading_(true), bytes_(std::move(bytes)) {}

  bool reading() const { return reading_; }
  /// What was written, once.
  std::string take() { return std::move(bytes_); }
  /// Of writing: room for so many bytes, so that they need not be moved.
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  bool at_end() const { return position_ == bytes_.size(); }
  /// Of reading: a count of values that follow, each of at least so many bytes. @throws InvalidInput when
  /// there are not as many.
  void require_left(std::uint64_t count, std::size_t bytes_each) const {
    if (reading_ && count > (bytes_.size() - position_) / bytes_each)
      throw InvalidInput("saved state: ends early");
  }

  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable<T>::value, "say how to archive this type");
    raw(&value, sizeof value);
  }
  void operator()(bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    raw(&byte, 1);
    if (byte > 1) throw InvalidInput("saved state: a yes or no that is neither");
    value = byte == 1;
  }
  void operator()(Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) (*this)(vector[axis]);
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    bool present = value.has_value();
    T held = value.value_or(T{});
    (*this)(present);
    (*this)(held);
    value = present ? std::optional<T>(held) : std::nullopt;
  }
  template <class T, class Allocator>
  void operator()(std::vector<T, Allocator>& values) {
    static_assert(std::is_trivially_copyable<T>::value, "say how to archive this type");
    std::uint64_t count = values.size();
    (*this)(count);
    require_left(count, sizeof(T));
    if (reading_) values.resize(count);
    raw(values.data(), count * sizeof(T));
  }

 private:
  void raw(void* data, std::size_t size) {
    if (size == 0) return;
    if (reading_) {
      if (size > bytes_.size() - position_) throw InvalidInput("saved state: ends early");
      std::memcpy(data, bytes_.data() + position_, size);
      position_ += size;
    } else {
      bytes_.append(static_cast<const char*>(data), size);
    }
  }

  bool reading_;
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace dmf::engine
