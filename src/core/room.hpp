#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace carom::detail {

/// Lets the system back these bytes by large pages where it can, if they are very many and nobody has written
/// to them yet: memory that is touched for the first time costs a call to the system for each page.
void use_large_pages(void* data, std::size_t bytes);

/// Makes room for more elements at once, so that the list neither moves while they come nor, if this is
/// called often, each time that it is.
template <class T, class Allocator>
void make_room(std::vector<T, Allocator>& list, std::size_t more) {
    const std::size_t needed = list.size() + more;
    if (needed <= list.capacity()) return;
    std::vector<T, Allocator> larger;
    larger.reserve(std::max(needed, 2 * list.capacity()));
    use_large_pages(larger.data(), larger.capacity() * sizeof(T));
    for (T& element : list) larger.push_back(std::move(element));
    list = std::move(larger);
}

}  // namespace carom::detail
