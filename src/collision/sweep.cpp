#include "collision/sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "collision/sweep_in_lanes.hpp"
#include "simd/width.hpp"

namespace carom::detail {

namespace {

/// A box that lies in more strips than this is kept apart.
constexpr std::uint32_t most_strips_of_a_box = 6;

/// The middle of the box and its size along an axis, for statistics.
template <int D>
float middle(const OuterBox<D>& box, int axis) {
    return 0.5f * box.lower[axis] + 0.5f * box.upper[axis];
}

template <int D>
bool is_bounded(const OuterBox<D>& box) {
    constexpr float far = 1e30f;
    for (int i = 0; i < D; ++i) {
        if (!(box.lower[i] > -far && box.upper[i] < far)) return false;
    }
    return true;
}

/// A number that orders as the (finite) float does.
std::uint32_t key_of(float f) {
    const auto bits = std::bit_cast<std::uint32_t>(f);
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

}  // namespace

template <>
const SweepKernel<2>& sweep_kernel_1() {
    return SweepIn<2, float>::kernel;
}
template <>
const SweepKernel<3>& sweep_kernel_1() {
    return SweepIn<3, float>::kernel;
}

template <int D>
const SweepKernel<D>& sweep_kernel() {
    switch (lane_width()) {
        case 4:
            return sweep_kernel_4<D>();
#ifdef CAROM_WIDE_LANES
        case 8:
            return sweep_kernel_8<D>();
        case 16:
            return sweep_kernel_16<D>();
#endif
        default:
            return sweep_kernel_1<D>();
    }
}

/// The axes by how far the boxes are spread along them, and strips about twice as wide as a box.
template <int D>
void Sweep<D>::choose_axes(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes) {
    Vec<D> sum{}, squares{}, size{};
    std::size_t count = 0;
    Aabb<D> range{};
    for (const std::uint32_t i : listed) {
        if (!is_bounded(boxes[i])) continue;
        Vec<D> center;
        for (int k = 0; k < D; ++k) {
            center[k] = static_cast<double>(middle(boxes[i], k));
            sum[k] += center[k];
            squares[k] += center[k] * center[k];
            size[k] += static_cast<double>(boxes[i].upper[k] - boxes[i].lower[k]);
        }
        range = count++ ? merged(range, Aabb<D>{center, center}) : Aabb<D>{center, center};
    }
    strips_ = 1;
    for (int k = 0; k < D; ++k) axes_[k] = k;
    if (count == 0) return;
    const double per = 1.0 / static_cast<double>(count);
    const auto spread = [&](int k) { return squares[k] - per * sum[k] * sum[k]; };
    std::stable_sort(axes_, axes_ + D, [&](int a, int b) { return spread(a) > spread(b); });
    const int across = axes_[1];
    const double extent = range.upper[across] - range.lower[across];
    const double width = std::max(2 * per * size[across], 1e-6 * extent);
    const double most = std::min(4096.0, 1 + static_cast<double>(count) / 32);
    const double strips = std::clamp(width > 0 ? extent / width : 1.0, 1.0, most);
    strips_ = static_cast<std::uint32_t>(strips);
    strip_begin_ = static_cast<float>(range.lower[across]);
    per_length_ = extent > 0 ? static_cast<float>(strips_ / extent) : 0.0f;
}

template <int D>
std::uint32_t Sweep<D>::strip_of(float at) const {
    const float strip = (at - strip_begin_) * per_length_;
    return strip > 0 ? static_cast<std::uint32_t>(std::min(strip, static_cast<float>(strips_ - 1))) : 0;
}

template <int D>
void Sweep<D>::arrange(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes) {
    choose_axes(listed, boxes);
    order_.clear();
    wide_.clear();
    starts_.assign(strips_ + 1, 0);
    for (const std::uint32_t i : listed) {
        const OuterBox<D>& box = boxes[i];
        if (!is_bounded(box)) {
            wide_.push_back(i);
            continue;
        }
        const std::uint32_t first = strip_of(box.lower[axes_[1]]), last = strip_of(box.upper[axes_[1]]);
        if (last - first >= most_strips_of_a_box) {
            wide_.push_back(i);
            continue;
        }
        order_.push_back({key_of(box.lower[axes_[0]]), i, first, last});
        for (std::uint32_t strip = first; strip <= last; ++strip) ++starts_[strip + 1];
    }
    for (std::uint32_t strip = 0; strip < strips_; ++strip)
        starts_[strip + 1] += starts_[strip] + SweepKernel<D>::most_lanes;
    sort();
    fill_columns(boxes);
}

/// By `key`, digit by digit.
template <int D>
void Sweep<D>::sort() {
    constexpr std::uint32_t digits = 2048, bits = 11;
    sorted_.resize(order_.size());
    for (std::uint32_t shift = 0; shift < 32; shift += bits) {
        std::array<std::uint32_t, digits + 1> begin{};
        for (const Ordered& item : order_) ++begin[((item.key >> shift) & (digits - 1)) + 1];
        for (std::uint32_t i = 0; i < digits; ++i) begin[i + 1] += begin[i];
        for (const Ordered& item : order_) sorted_[begin[(item.key >> shift) & (digits - 1)]++] = item;
        std::swap(order_, sorted_);
    }
}

template <int D>
void Sweep<D>::fill_columns(std::span<const OuterBox<D>> boxes) {
    const std::size_t places = starts_.back();
    places_.resize(places);
    found_.resize(places + SweepKernel<D>::most_lanes);
    for (int k = 0; k < D; ++k) {
        // What lies between the strips begins beyond any end.
        lower_[k].assign(places + SweepKernel<D>::most_lanes, std::numeric_limits<float>::infinity());
        upper_[k].resize(places + SweepKernel<D>::most_lanes);
    }
    next_.assign(starts_.begin(), starts_.end());
    for (const Ordered& item : order_) {
        for (std::uint32_t strip = item.first_strip; strip <= item.last_strip; ++strip) {
            const std::uint32_t place = next_[strip]++;
            places_[place] = {item.box, item.first_strip};
            for (int k = 0; k < D; ++k) {
                lower_[k][place] = boxes[item.box].lower[axes_[k]];
                upper_[k][place] = boxes[item.box].upper[axes_[k]];
            }
        }
    }
}

template <int D>
SweepColumns<D> Sweep<D>::columns() const {
    SweepColumns<D> columns;
    for (int k = 0; k < D; ++k) {
        columns.lower[k] = lower_[k].data();
        columns.upper[k] = upper_[k].data();
    }
    return columns;
}

template const SweepKernel<2>& sweep_kernel();
template const SweepKernel<3>& sweep_kernel();
template class Sweep<2>;
template class Sweep<3>;

}  // namespace carom::detail
