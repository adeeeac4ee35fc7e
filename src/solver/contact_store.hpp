#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/contact.hpp"
#include "dynamics/contact_cache.hpp"
#include "solver/lane_shapes.hpp"
#include "solver/lane_store.hpp"
#include "solver/passes.hpp"

namespace carom::detail {

/// The two bodies of a contact, as slots of the solver and as indices of the world.
struct BodyPair {
    std::uint32_t slot_a = 0, slot_b = 0;
    std::uint32_t body_a = 0, body_b = 0;
};

/// What keeps a contact up to date: the manifold as it was found, which is carried along as long as the cache
/// says, and then made anew if both shapes are for lanes.
template <int D>
struct Carrying {
    const ContactCache<D>& cache;
    LanePair<D> shapes;
};

/// The contacts of one colour, from step to step. They lie in lanes without gaps: contact i is lane i mod
/// width of block i / width. What is left of the last block holds nobody.
template <int D>
class ContactStore {
  public:
    using Rows = ContactRows<D, float>;
    using Marks = ContactMarks<D, float>;
    static constexpr std::uint32_t nobody = 0;  ///< slot of a lane that holds no contact
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// Before the first contact.
    void set_passes(const Passes<D>& passes);

    /// Appends a contact, whose rows are to be written yet, and returns its index.
    std::uint32_t push(std::uint32_t contact, const BodyPair& bodies, std::uint32_t first_movable);
    /// Takes a contact out. The last one takes its index; its number is returned, or `none` if it was the
    /// last.
    std::uint32_t remove(std::uint32_t index, std::uint32_t first_movable);

    /// Fills the rows of a contact from its record. With `carrying` it is kept up to date from step to step
    /// by `refresh`; without, its points stay as they are until they are written again.
    void write(std::uint32_t index, const ContactRecord<D>& record, const Carrying<D>* carrying);
    /// Completes the record by what the rows hold. `cache` is what the contact was last written with, and is
    /// brought up to date, too.
    void read(std::uint32_t index, ContactCache<D>& cache, ContactRecord<D>& record) const;
    /// Is the contact kept up to date by `refresh`?
    bool is_carried(std::uint32_t index) const;

    const Passes<D>& passes() const { return *passes_; }
    std::size_t width() const { return rows_.width(); }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::size_t blocks() const { return traits_.size(); }

    LaneStore<Rows>& rows() { return rows_; }
    const LaneStore<Rows>& rows() const { return rows_; }
    float restitution(std::uint32_t index) const;
    /// Can it be that some contact has restitution?
    bool some_bounce() const { return some_bounce_; }
    std::uint32_t contact(std::size_t index) const { return contact_[index]; }
    void rename(std::uint32_t index, std::uint32_t contact) { contact_[index] = contact; }
    /// Slots of its bodies.
    std::uint32_t a(std::size_t index) const { return slot_of<D>(a_[index]); }
    std::uint32_t b(std::size_t index) const { return slot_of<D>(b_[index]); }
    std::uint32_t body_a(std::size_t index) const { return body_a_[index]; }
    std::uint32_t body_b(std::size_t index) const { return body_b_[index]; }
    std::uint8_t traits(std::size_t block) const { return traits_[block]; }
    /// A bit a lane: what the last pass found.
    std::uint32_t found(std::size_t block) const { return found_[block]; }

    /// The blocks from `first` on, `count` of them.
    BlockSpan<D> span(std::size_t first, std::size_t count);
    BlockSpan<D> span() { return span(0, blocks()); }

  private:
    void mark_fixed(std::size_t block, std::uint32_t first_movable);
    void clear(std::uint32_t index);

    const Passes<D>* passes_ = nullptr;
    std::size_t size_ = 0;
    bool some_bounce_ = false;
    LaneStore<Rows> rows_;
    LaneStore<Marks> marks_;
    std::vector<std::uint32_t> a_, b_;                                ///< records of the bodies, by lane
    std::vector<std::uint32_t> body_a_, body_b_, shape_a_, shape_b_;  ///< by lane
    std::vector<std::uint32_t> contact_;                              ///< by lane
    std::vector<std::uint8_t> traits_;                                ///< by block
    std::vector<std::uint32_t> found_;                                ///< by block
};

}  // namespace carom::detail
