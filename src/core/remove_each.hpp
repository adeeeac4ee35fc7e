#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace carom::detail {

/// Removes the picked ones of `items`, by `remove(index)`, which moves the last item into the gap. The order
/// of what stays depends on nothing but what goes. `picked` is empty then.
template <class Item, class Remove>
void remove_each(std::vector<std::uint32_t>& picked, const std::vector<Item>& items, const Remove& remove) {
    std::ranges::sort(picked);
    picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
    std::size_t left = 0, right = picked.size();
    while (left < right) {
        const std::size_t last = items.size() - 1;
        remove(picked[left]);
        // Where the last is picked as well, it goes from the gap that it has come to.
        const bool again = right > left + 1 && picked[right - 1] == last;
        again ? --right : ++left;
    }
    picked.clear();
}

}  // namespace carom::detail
