#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <vector>

namespace carom::detail {

/// Which of the floats of its record a member is.
template <class Record>
std::size_t field_of(const Record& record, const float& member) {
    return static_cast<std::size_t>(&member - reinterpret_cast<const float*>(&record));
}

/// An array of records that consist of nothing but floats (`Record` is `Rows<float>` for some `Rows<F>`),
/// laid out in blocks: a block is a `Rows<Lanes>`, and each of its lanes a record. The width is known at run
/// time; this class sees a block as so many fields of `width` floats.
template <class Record>
class LaneStore {
  public:
    static constexpr std::size_t fields = sizeof(Record) / sizeof(float);
    using Floats = std::array<float, fields>;

    void set_width(int width) { width_ = static_cast<std::size_t>(width); }
    std::size_t width() const { return width_; }
    /// How many blocks `count` records take.
    std::size_t blocks_for(std::size_t count) const { return (count + width_ - 1) / width_; }

    /// Room for this many blocks; what they hold is not defined.
    void resize(std::size_t blocks) {
        const std::size_t lines = (blocks * fields * width_ + line_floats - 1) / line_floats;
        if (lines > lines_.size()) lines_.resize(lines);
    }
    float* data() { return lines_.empty() ? nullptr : lines_[0].floats.data(); }
    const float* data() const { return lines_.empty() ? nullptr : lines_[0].floats.data(); }

    /// One field of a record.
    float& at(std::size_t record, std::size_t field) { return data()[place(record, field)]; }
    float at(std::size_t record, std::size_t field) const { return data()[place(record, field)]; }

    Record get(std::size_t record) const {
        Floats all;
        const float* from = data() + place(record, 0);
        for (std::size_t f = 0; f < fields; ++f) all[f] = from[f * width_];
        return std::bit_cast<Record>(all);
    }
    /// Sets the record, or only its first fields.
    void set(std::size_t record, const Record& value, std::size_t count = fields) {
        const Floats all = std::bit_cast<Floats>(value);
        float* to = data() + place(record, 0);
        for (std::size_t f = 0; f < count; ++f) to[f * width_] = all[f];
    }

  private:
    static constexpr std::size_t line_floats = 16;
    struct alignas(64) Line {
        std::array<float, line_floats> floats{};
    };

    std::size_t place(std::size_t record, std::size_t field) const {
        return (record / width_ * fields + field) * width_ + record % width_;
    }

    std::size_t width_ = 1;
    std::vector<Line> lines_;
};

}  // namespace carom::detail
