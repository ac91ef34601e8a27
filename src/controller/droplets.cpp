#include "controller/droplets.h"

#include <algorithm>
#include <tuple>

namespace dmf::controller {

namespace {

std::vector<Droplet> connected_droplets(const Layout& layout, const Wetting& wetting, double threshold) {
  std::vector<Droplet> found;
  Channels open;
  for (const auto& [channel, fraction] : wetting)
    if (fraction >= threshold) open.insert(channel);
  while (!open.empty()) {
    Droplet droplet;
    std::vector<Channel> ahead{*open.begin()};
    open.erase(open.begin());
    droplet.main = ahead.front();
    while (!ahead.empty()) {
      const Channel channel = ahead.back();
      ahead.pop_back();
      droplet.channels.insert(channel);
      droplet.covered += wetting.at(channel);
      if (wetting.at(channel) > wetting.at(droplet.main)) droplet.main = channel;
      for (const Channel neighbour : layout.neighbours(channel))
        if (open.erase(neighbour)) ahead.push_back(neighbour);
    }
    found.push_back(droplet);
  }
  return found;
}

/// How much of a droplet's past another one is: shared electrodes before neighbouring ones.
double kinship(const Layout& layout, const Droplet& before, const Droplet& now, const Wetting& wetting) {
  constexpr double kOnlyBeside = 1e-3;
  double shared = 0;
  for (const Channel channel : now.channels) {
    if (before.channels.count(channel)) {
      shared += wetting.at(channel);
    } else {
      for (const Channel neighbour : layout.neighbours(channel))
        if (before.channels.count(neighbour)) shared += kOnlyBeside * wetting.at(channel);
    }
  }
  return shared;
}

}  // namespace

Wetting wetting_of(const Layout& layout, const Reading& reading) {
  const Sensing& sensing = layout.sensing();
  Wetting wetting;
  for (const Channel channel : layout.channels()) {
    const auto sensed = reading.capacitance.find(channel);
    const double area = layout.area(channel);
    wetting[channel] = sensed == reading.capacitance.end()
                           ? 0
                           : (sensed->second - sensing.offset - sensing.filler_capacitance * area) /
                                 ((sensing.liquid_capacitance - sensing.filler_capacitance) * area);
  }
  return wetting;
}

const std::vector<Droplet>& DropletFinder::update(const Wetting& wetting) {
  std::vector<Droplet> found = connected_droplets(layout_, wetting, threshold_);
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // kinship, before, now
  for (std::size_t before = 0; before < droplets_.size(); ++before) {
    for (std::size_t now = 0; now < found.size(); ++now) {
      const double shared = kinship(layout_, droplets_[before], found[now], wetting);
      if (shared > 0) pairs.emplace_back(-shared, before, now);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> continued(droplets_.size());
  for (const auto& [shared, before, now] : pairs) {
    if (continued[before] || found[now].id) continue;
    continued[before] = true;
    found[now].id = droplets_[before].id;
  }
  for (Droplet& droplet : found)
    if (!droplet.id) droplet.id = next_id_++;
  std::sort(found.begin(), found.end(), [](const Droplet& a, const Droplet& b) { return a.id < b.id; });
  droplets_ = std::move(found);
  return droplets_;
}

const Droplet* DropletFinder::on(Channel channel) const {
  for (const Droplet& droplet : droplets_)
    if (droplet.channels.count(channel)) return &droplet;
  return nullptr;
}

}  // namespace dmf::controller
