#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace carom::detail {

/// A list that most often has one element, which then lies in the list itself.
template <class T>
class ShortList {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    ShortList() = default;
    ShortList(const ShortList& other) : ShortList() {
        for (const T& element : other) push_back(element);
    }
    ShortList(ShortList&& other) noexcept : ShortList() { swap(other); }
    ShortList& operator=(ShortList other) noexcept {
        swap(other);
        return *this;
    }
    ~ShortList() {
        if (!in_place()) delete[] held_.many;
    }

    void push_back(T element) {
        if (count_ == room_) grow();
        elements()[count_++] = element;
    }
    /// Takes out the elements that are equal to this one; the others keep their order.
    void erase(const T& element) {
        T* const first = elements();
        count_ = static_cast<std::uint32_t>(std::remove(first, first + count_, element) - first);
    }

    std::size_t size() const { return count_; }
    bool empty() const { return count_ == 0; }
    const T* data() const { return in_place() ? &held_.one : held_.many; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + count_; }
    const T& operator[](std::size_t i) const { return data()[i]; }

  private:
    bool in_place() const { return room_ == 1; }
    T* elements() { return in_place() ? &held_.one : held_.many; }

    void grow() {
        T* larger = new T[2 * std::size_t{room_}];
        std::copy(begin(), end(), larger);
        if (!in_place()) delete[] held_.many;
        held_.many = larger;
        room_ *= 2;
    }
    void swap(ShortList& other) noexcept {
        std::swap(held_, other.held_);
        std::swap(count_, other.count_);
        std::swap(room_, other.room_);
    }

    union Held {
        T one{};
        T* many;
    };
    Held held_;
    std::uint32_t count_ = 0, room_ = 1;
};

}  // namespace carom::detail
