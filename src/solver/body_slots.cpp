#include "solver/body_slots.hpp"

namespace carom::detail {

bool BodySlots::follow(std::span<const std::uint32_t> awake, std::span<const BodyType> types) {
    for (const std::uint32_t body : changes_) changed_[body] = 0;
    changes_.clear();
    slot_.resize(types.size(), still);
    changed_.resize(types.size(), 0);
    follows_.resize(types.size(), 0);

    std::uint32_t kinematic = 0;
    for (const std::uint32_t body : awake) {
        follows_[body] = 1;
        kinematic += types[body] != BodyType::dynamic;
    }
    for (const std::uint32_t body : followed_) {
        const bool dynamic = types[body] == BodyType::dynamic;
        if (!follows_[body] || dynamic != (slot_[body] >= first_movable_)) release(body);
    }
    // Slots are dealt anew when there are too few for kinematic bodies, or far more than bodies.
    const bool crowded = kinematic >= first_movable_, sparse = free_.size() > 64 + awake.size();
    if (crowded || sparse) {
        for (const std::uint32_t body : followed_) {
            if (slot_[body] != still) release(body);
        }
        while (kinematic >= first_movable_) first_movable_ *= 2;
        body_.assign(first_movable_, none);
        free_.clear();
    }
    for (const std::uint32_t body : awake) {
        if (slot_[body] == still) take(body, types[body] == BodyType::dynamic);
        follows_[body] = 0;
    }
    followed_.assign(awake.begin(), awake.end());
    return !changes_.empty();
}

void BodySlots::take(std::uint32_t body, bool dynamic) {
    std::uint32_t slot = 1;
    if (!dynamic) {
        while (body_[slot] != none) ++slot;
    } else if (!free_.empty()) {
        slot = free_.back();
        free_.pop_back();
    } else {
        slot = size();
        body_.push_back(none);
    }
    body_[slot] = body;
    slot_[body] = slot;
    mark(body);
}

void BodySlots::release(std::uint32_t body) {
    const std::uint32_t slot = slot_[body];
    slot_[body] = still;
    body_[slot] = none;
    if (slot >= first_movable_) free_.push_back(slot);
    mark(body);
}

void BodySlots::mark(std::uint32_t body) {
    if (changed_[body]) return;
    changed_[body] = 1;
    changes_.push_back(body);
}

}  // namespace carom::detail
