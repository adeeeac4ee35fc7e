#include "collision/sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

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

/// The axes by how far the boxes are spread along them, and strips about twice as wide as a box. Some
/// hundreds of boxes tell, taken from all over the list but not at equal intervals, as they may lie in rows.
template <int D>
void Sweep<D>::choose_axes(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes) {
    constexpr std::size_t enough = 512;
    const std::size_t asked = std::min(listed.size(), enough);
    const auto chosen = [&](std::size_t i) {
        if (asked == listed.size()) return listed[i];
        constexpr std::uint64_t golden_section = 0x9e3779b9;  // of 2³²
        const std::uint64_t share = (i * golden_section) & 0xffffffff;
        return listed[static_cast<std::size_t>((share * listed.size()) >> 32)];
    };
    Vec<D> sum{}, squares{}, size{};
    std::size_t count = 0;
    Aabb<D> range{};
    for (std::size_t i = 0; i < asked; ++i) {
        const OuterBox<D>& box = boxes[chosen(i)];
        if (!is_bounded(box)) continue;
        Vec<D> center;
        for (int k = 0; k < D; ++k) {
            center[k] = static_cast<double>(middle(box, k));
            sum[k] += center[k];
            squares[k] += center[k] * center[k];
            size[k] += static_cast<double>(box.upper[k] - box.lower[k]);
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
    const double most = std::min(4096.0, 1 + static_cast<double>(listed.size()) / 32);
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
}

/// By `key`, digit by digit.
template <int D>
void Sweep<D>::sort() {
    constexpr std::uint32_t digits = 2048, bits = 11, passes = 3;
    std::array<std::array<std::uint32_t, digits>, passes> counts{};
    const auto digit = [](std::uint32_t key, std::uint32_t pass) {
        return (key >> (pass * bits)) & (digits - 1);
    };
    for (const Ordered& item : order_) {
        for (std::uint32_t pass = 0; pass < passes; ++pass) ++counts[pass][digit(item.key, pass)];
    }
    sorted_.resize(order_.size());
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        std::uint32_t next = 0;
        for (std::uint32_t& count : counts[pass]) next += std::exchange(count, next);
        for (const Ordered& item : order_) sorted_[counts[pass][digit(item.key, pass)]++] = item;
        std::swap(order_, sorted_);
    }
}

template <int D>
void Sweep<D>::fill_columns(std::span<const OuterBox<D>> boxes, std::span<const OuterBox<D>> before,
                            Scheduler* scheduler) {
    places_.assign(starts_.back() + SweepKernel<D>::most_lanes, {});
    next_.assign(starts_.begin(), starts_.end());
    for (const Ordered& item : order_) {
        for (std::uint32_t strip = item.first_strip; strip <= item.last_strip; ++strip)
            places_[next_[strip]++] = {item.box, strip, item.first_strip};
    }
    for (auto* columns : {lower_, upper_, lower_before_, upper_before_}) {
        for (int k = 0; k < D; ++k) columns[k].resize(places_.size());
    }
    constexpr std::size_t worth_a_worker = 1024;
    run_range(scheduler, places_.size(), worth_a_worker, [&](std::size_t begin, std::size_t end) {
        for (std::size_t place = begin; place < end; ++place) {
            // What lies between the strips begins beyond any end.
            const std::uint32_t i = places_[place].box;
            const OuterBox<D> box = i == nobody ? no_box<D>() : boxes[i];
            const OuterBox<D> old = i == nobody ? no_box<D>() : before[i];
            for (int k = 0; k < D; ++k) {
                lower_[k][place] = box.lower[axes_[k]];
                upper_[k][place] = box.upper[axes_[k]];
                lower_before_[k][place] = old.lower[axes_[k]];
                upper_before_[k][place] = old.upper[axes_[k]];
            }
        }
    });
}

template <int D>
SweepColumns<D> Sweep<D>::columns() const {
    SweepColumns<D> columns;
    for (int k = 0; k < D; ++k) {
        columns.lower[k] = lower_[k].data();
        columns.upper[k] = upper_[k].data();
        columns.lower_before[k] = lower_before_[k].data();
        columns.upper_before[k] = upper_before_[k].data();
    }
    return columns;
}

/// The pairs of the places from `begin` to `end` and later ones.
template <int D>
void Sweep<D>::look_along(std::uint32_t begin, std::uint32_t end, std::vector<Pair>& pairs) const {
    const SweepKernel<D>& kernel = sweep_kernel<D>();
    const SweepColumns<D> columns = this->columns();
    constexpr std::uint32_t room = 256;
    std::array<SweepPair, room> found;
    for (SweepCursor cursor{begin, begin + 1}; cursor.row < end;) {
        const std::uint32_t count = kernel.find(columns, cursor, end, found.data(), room);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Place &one = places_[found[i].row], &other = places_[found[i].other];
            // Two that share several strips meet in the first of these.
            const bool here = std::max(one.first_strip, other.first_strip) == one.strip;
            if (here) pairs.push_back({one.box, other.box});
        }
    }
}

template <int D>
void Sweep<D>::look(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes,
                    std::span<const OuterBox<D>> before, Scheduler* scheduler) {
    constexpr std::size_t stretch = 512;
    arrange(listed, boxes);
    fill_columns(boxes, before, scheduler);
    pairs_.look_through(scheduler, starts_.back(), stretch,
                        [&](std::size_t begin, std::size_t end, std::vector<Pair>& pairs) {
                            look_along(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                                       pairs);
                        });
    // Those that are kept apart, with one another, and with all others.
    const auto meet = [&](std::uint32_t a, std::uint32_t b, std::vector<Pair>& pairs) {
        if (overlaps(boxes[a], boxes[b]) && !overlapped(before[a], before[b])) pairs.push_back({a, b});
    };
    const std::size_t wide = wide_.size(), others = wide > 0 ? wide + order_.size() : 0;
    wide_pairs_.look_through(scheduler, others, stretch,
                             [&](std::size_t begin, std::size_t end, std::vector<Pair>& pairs) {
                                 for (std::size_t i = begin; i < end; ++i) {
                                     const std::uint32_t box = i < wide ? wide_[i] : order_[i - wide].box;
                                     for (std::size_t k = 0; k < std::min(i, wide); ++k)
                                         meet(wide_[k], box, pairs);
                                 }
                             });
}

template const SweepKernel<2>& sweep_kernel();
template const SweepKernel<3>& sweep_kernel();
template class Sweep<2>;
template class Sweep<3>;

}  // namespace carom::detail
