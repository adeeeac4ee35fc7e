#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace carom::detail {

/// Gives out memory of zeros, and leaves it as it is where an element is to have its default. Much of it
/// comes from the system so, which provides it when it is first written to.
template <class T>
struct ZeroedAllocator {
    using value_type = T;

    ZeroedAllocator() = default;
    template <class U>
    ZeroedAllocator(const ZeroedAllocator<U>&) {}

    T* allocate(std::size_t count) {
        static_assert(alignof(T) <= alignof(std::max_align_t));
        if (void* data = std::calloc(count, sizeof(T))) return static_cast<T*>(data);
        throw std::bad_alloc();
    }
    void deallocate(T* data, std::size_t) { std::free(data); }

    template <class U>
    void construct(U*) {
        static_assert(std::is_trivially_copyable_v<U>);
    }
    template <class U, class... Parts>
    void construct(U* place, Parts&&... parts) {
        ::new (static_cast<void*>(place)) U(std::forward<Parts>(parts)...);
    }

    friend bool operator==(const ZeroedAllocator&, const ZeroedAllocator&) { return true; }
};

/// A list that never becomes shorter, of elements whose default is all zeros: those to which nobody has
/// written take no memory where there are many.
template <class T>
using Column = std::vector<T, ZeroedAllocator<T>>;

}  // namespace carom::detail
