#include "chip/hash_chain.h"

#include <cassert>
#include <string>

#include "engine/noise.h"

namespace dmf::chip {

namespace {

std::uint64_t fold(std::uint64_t value, std::uint64_t more) {
  return engine::mix64(value ^ engine::mix64(more));
}

/// FNV-1a (Fowler, Noll, Vo) of the text, folded in with its length: no two lists of texts run together.
std::uint64_t fold(std::uint64_t value, const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return fold(fold(value, text.size()), hash);
}

}  // namespace

std::uint64_t fingerprint(const SceneFiles& files) {
  std::uint64_t value = 1;
  for (const SceneFile& file : files.all()) value = fold(fold(value, file.role), file.text);
  return value;
}

HashChain::HashChain(std::uint64_t scene_fingerprint, std::uint64_t seed, std::uint64_t interval)
    : interval_(interval), start_(fold(fold(scene_fingerprint, seed), interval)) {
  assert(interval > 0);
}

StateRecord HashChain::add(std::uint64_t step, std::uint64_t hash, const std::vector<CommandRecord>& history,
                           std::size_t count) {
  assert(count <= history.size());
  StateRecord record;
  record.index = last_ ? last_->index + 1 : 0;
  record.step = step;
  record.commands = static_cast<std::uint32_t>(count);
  record.hash = hash;
  record.chain = link_ ? link_->chain : start_;
  for (std::size_t i = link_ ? link_->commands : 0; i < count; ++i) {
    record.chain = fold(fold(record.chain, history[i].step), to_json(history[i].command));
  }
  record.chain = fold(fold(record.chain, step), hash);
  if (is_link(step)) link_ = record;
  last_ = record;
  return record;
}

void HashChain::adopt(const StateRecord& link) {
  link_ = link;
  last_ = link;
}

}  // namespace dmf::chip
