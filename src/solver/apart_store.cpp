#include "solver/apart_store.hpp"

#include <bit>

#include "simd/width.hpp"
#include "solver/split_pose.hpp"

namespace carom::detail {

template <int D>
ApartStore<D>::ApartStore() : passes_(&passes_of_width<D>(lane_width())) {
    marks_.set_width(passes_->width);
}

template <int D>
std::uint32_t ApartStore<D>::add(std::uint32_t contact, std::uint32_t body_a, std::uint32_t body_b,
                                 const ContactCache<D>& cache, double radius_a, double radius_b,
                                 const LanePair<D>& shapes) {
    const auto index = static_cast<std::uint32_t>(size());
    contact_.push_back(contact);
    if (index % marks_.width() == 0) {
        const std::size_t lanes = index + marks_.width();
        marks_.resize(lanes / marks_.width());
        body_a_.resize(lanes, body_a);
        body_b_.resize(lanes, body_b);
        shape_a_.resize(lanes, LaneShapes<D>::none);
        shape_b_.resize(lanes, LaneShapes<D>::none);
        for (std::size_t lane = index; lane < lanes; ++lane) marks_.set(lane, {});
    }
    body_a_[index] = body_a;
    body_b_[index] = body_b;
    shape_a_[index] = shapes.a;
    shape_b_[index] = shapes.b;
    ApartMarks<D, float> marks;
    set_pose(cache.pose, marks.place, marks.place_rest, marks.turn, marks.turn_rest);
    marks.normal = cache.normal;
    marks.gap = cache.tells_of_gap() ? cache.gap : -no_separation;
    marks.can_be_remade = shapes ? 1.0f : 0.0f;
    marks.radius_a = static_cast<float>(radius_a);
    marks.radius_b = static_cast<float>(radius_b);
    marks_.set(index, marks);
    return index;
}

template <int D>
std::uint32_t ApartStore<D>::remove(std::uint32_t index) {
    const auto last = static_cast<std::uint32_t>(size() - 1);
    const std::uint32_t moved = index == last ? none : contact_[last];
    if (index != last) {
        marks_.set(index, marks_.get(last));
        contact_[index] = moved;
        body_a_[index] = body_a_[last];
        body_b_[index] = body_b_[last];
        shape_a_[index] = shape_a_[last];
        shape_b_[index] = shape_b_[last];
    }
    contact_.pop_back();
    if (last % marks_.width() == 0) {
        body_a_.resize(last);
        body_b_.resize(last);
        shape_a_.resize(last);
        shape_b_.resize(last);
    } else {  // the lane goes on reading bodies that exist
        const std::uint32_t first = last - last % static_cast<std::uint32_t>(marks_.width());
        body_a_[last] = body_a_[first];
        body_b_[last] = body_b_[first];
        shape_a_[last] = shape_b_[last] = LaneShapes<D>::none;
        marks_.set(last, {});
    }
    return moved;
}

template <int D>
std::span<const std::uint32_t> ApartStore<D>::find_near(std::span<const BodyState<D>> states,
                                                        const LaneShapes<D>& shapes,
                                                        const ApartLimits<float>& limits,
                                                        Scheduler* scheduler) {
    near_.clear();
    const std::size_t width = marks_.width(), blocks = marks_.blocks_for(size());
    found_.resize(blocks);
    const PoseView<D> poses{reinterpret_cast<const double*>(states.data())};
    run_range(scheduler, blocks, 16, [&](std::size_t begin, std::size_t end) {
        passes_->find_near(
            {marks_.data() + begin * width * LaneStore<ApartMarks<D, float>>::fields,
             body_a_.data() + begin * width, body_b_.data() + begin * width, shape_a_.data() + begin * width,
             shape_b_.data() + begin * width, found_.data() + begin, end - begin},
            poses, shapes.data(), limits);
    });
    for (std::size_t block = 0; block < blocks; ++block) {
        for (std::uint32_t left = found_[block]; left != 0; left &= left - 1) {
            const std::size_t index = block * width + static_cast<std::size_t>(std::countr_zero(left));
            if (index < size()) near_.push_back(contact_[index]);
        }
    }
    return near_;
}

template class ApartStore<2>;
template class ApartStore<3>;

}  // namespace carom::detail
