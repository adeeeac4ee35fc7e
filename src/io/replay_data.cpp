#include "io/replay_data.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <tuple>

namespace carom::io {
namespace {

using Column = std::vector<std::int32_t>;

std::string base64(std::span<const unsigned char> bytes) {
    static constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// Compresses columns of integers one after the other. Small integers of either sign become small unsigned
/// ones (zig-zag), and all their lowest bytes are written first, then all the second ones, as far as there
/// are any: bytes of equal meaning stand together, which is what deflate can make small.
class ColumnStream {
  public:
    ColumnStream() {
        if (deflateInit(&stream_, Z_DEFAULT_COMPRESSION) != Z_OK) throw std::bad_alloc();
    }
    ~ColumnStream() { deflateEnd(&stream_); }
    ColumnStream(const ColumnStream&) = delete;
    ColumnStream& operator=(const ColumnStream&) = delete;

    /// Returns the number of bytes that each value takes.
    int add(const Column& values) {
        const auto zigzag = [](std::int32_t v) {
            return static_cast<std::uint32_t>(v) << 1 ^ static_cast<std::uint32_t>(v >> 31);
        };
        std::uint32_t largest = 0;
        for (const std::int32_t v : values) largest = std::max(largest, zigzag(v));
        int planes = 0;
        for (; planes < 4 && (planes == 0 || largest >> (8 * planes) != 0); ++planes) {
            std::vector<unsigned char> plane;
            plane.reserve(values.size());
            for (const std::int32_t v : values)
                plane.push_back(static_cast<unsigned char>(zigzag(v) >> (8 * planes)));
            compress(plane, Z_NO_FLUSH);
        }
        return planes;
    }

    std::string finish() {
        compress({}, Z_FINISH);
        return base64(output_);
    }

  private:
    void compress(std::span<const unsigned char> bytes, int flush) {
        stream_.next_in = const_cast<unsigned char*>(bytes.data());  // zlib reads it only
        stream_.avail_in = static_cast<uInt>(bytes.size());
        std::array<unsigned char, 1 << 16> chunk;
        do {
            stream_.next_out = chunk.data();
            stream_.avail_out = static_cast<uInt>(chunk.size());
            if (deflate(&stream_, flush) == Z_STREAM_ERROR) throw std::logic_error("deflate lost its state");
            output_.insert(output_.end(), chunk.data(), chunk.data() + (chunk.size() - stream_.avail_out));
        } while (stream_.avail_out == 0);
    }

    z_stream stream_{};
    std::vector<unsigned char> output_;
};

/// A number that a body has in each frame, and the finest step in which it is written.
struct Channel {
    const char* name;
    double resolution;
    int order;  ///< of the differences in time that are written
    std::function<double(const ReplayState&)> read;
};

constexpr double position_resolution = 1e-4;
constexpr double angle_resolution = 1e-4;
constexpr double quaternion_resolution = 1.0 / 32767;
constexpr double velocity_resolution = 1e-3;

std::vector<Channel> channels_of(int dimension) {
    const auto position = [](int i) { return [i](const ReplayState& s) { return s.position[i]; }; };
    const auto rotation = [](int i) { return [i](const ReplayState& s) { return double(s.rotation[i]); }; };
    const auto velocity = [](int i) { return [i](const ReplayState& s) { return double(s.velocity[i]); }; };
    const auto turning = [](int i) {
        return [i](const ReplayState& s) { return double(s.angular_velocity[i]); };
    };
    const auto angle = [](const ReplayState& s) {
        return 2 * std::atan2(double(s.rotation[2]), double(s.rotation[3]));
    };
    if (dimension == 2)
        return {{"x", position_resolution, 2, position(0)},  {"y", position_resolution, 2, position(1)},
                {"angle", angle_resolution, 2, angle},       {"vx", velocity_resolution, 1, velocity(0)},
                {"vy", velocity_resolution, 1, velocity(1)}, {"w", velocity_resolution, 1, turning(2)}};
    return {{"x", position_resolution, 2, position(0)},    {"y", position_resolution, 2, position(1)},
            {"z", position_resolution, 2, position(2)},    {"qx", quaternion_resolution, 2, rotation(0)},
            {"qy", quaternion_resolution, 2, rotation(1)}, {"qz", quaternion_resolution, 2, rotation(2)},
            {"qw", quaternion_resolution, 2, rotation(3)}, {"vx", velocity_resolution, 1, velocity(0)},
            {"vy", velocity_resolution, 1, velocity(1)},   {"vz", velocity_resolution, 1, velocity(2)},
            {"wx", velocity_resolution, 1, turning(0)},    {"wy", velocity_resolution, 1, turning(1)},
            {"wz", velocity_resolution, 1, turning(2)}};
}

bool finite(const ReplayState& state) {
    const auto all = [](const auto& values) {
        return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    };
    return all(state.position) && all(state.rotation) && all(state.velocity) && all(state.angular_velocity);
}

const ReplayState* state_of(const ReplayFrame& frame, std::size_t body) {
    if (body >= frame.states.size() || !frame.states[body].present) return nullptr;
    return &frame.states[body];
}

/// The states of one body in all frames, without gaps: where it is absent or not finite it stays as it was,
/// and before its first state it waits where that will be.
std::vector<ReplayState> history_of(const Replay& replay, std::size_t body) {
    std::vector<ReplayState> history(replay.frames.size());
    const ReplayState* last = nullptr;
    std::size_t waiting = 0;
    for (std::size_t f = 0; f < history.size(); ++f) {
        const ReplayState* state = state_of(replay.frames[f], body);
        if (state && finite(*state)) {
            if (!last)
                std::fill(history.begin(), history.begin() + static_cast<std::ptrdiff_t>(waiting), *state);
            last = state;
        }
        if (last)
            history[f] = *last;
        else
            ++waiting;
    }
    // A quaternion and its opposite are the same rotation; the one nearer to the frame before keeps the
    // differences small and the interpolation on the short way.
    for (std::size_t f = 1; f < history.size(); ++f) {
        auto& q = history[f].rotation;
        const auto& p = history[f - 1].rotation;
        if (p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] < 0)
            for (float& component : q) component = -component;
    }
    return history;
}

/// Angles that go on past a full turn: of all that mean the same, the one nearest to where the angular
/// velocity leads to from the frame before, so that wheels turn the right way however fast.
void unwrap(std::span<double> angles, std::span<const ReplayState> history, double step) {
    constexpr double turn = 2 * std::numbers::pi;
    for (std::size_t f = 1; f < angles.size(); ++f) {
        const double mean = (history[f - 1].angular_velocity[2] + history[f].angular_velocity[2]) / 2;
        const double expected = angles[f - 1] + mean * step;
        angles[f] += turn * std::round((expected - angles[f]) / turn);
    }
}

/// Replaces values by their differences of the given order. The arithmetic is modulo 2³², so that the sums
/// give back every value whatever the differences are.
void difference(std::span<std::int32_t> values, int order) {
    for (int k = 0; k < order; ++k)
        for (std::size_t i = values.size(); i-- > 1;)
            values[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(values[i]) -
                                                  static_cast<std::uint32_t>(values[i - 1]));
}

/// The step in which values up to `largest` are written: it grows when they would not fit an integer.
double scale_for(double resolution, double largest) {
    return std::max(resolution, largest / (std::numeric_limits<std::int32_t>::max() / 2));
}

std::int32_t quantise(double value, double scale) {
    return static_cast<std::int32_t>(std::llround(value / scale));
}

using BodyPair = std::tuple<std::int32_t, std::int32_t>;

/// A contact in whole numbers, with its place relative to that of a body.
struct CodedContact {
    BodyPair bodies;
    std::array<std::int32_t, 7> values{};  ///< place, normal (as many as there are dimensions), impulse
};

constexpr double contact_resolution = 1e-3;
constexpr double normal_resolution = 1e-2;
constexpr double impulse_unit = 1e-4;
constexpr double impulse_steps = 16;  ///< to the octave

std::int32_t coded_impulse(float impulse) {
    if (!(impulse > 0) || !std::isfinite(impulse)) return 0;
    return static_cast<std::int32_t>(std::lround(impulse_steps * std::log2(1 + impulse / impulse_unit)));
}

/// The contacts of a frame by pair of bodies; those of one pair stay in their order.
std::vector<CodedContact> coded_contacts(const Replay& replay, const ReplayFrame& frame) {
    const auto size = static_cast<std::size_t>(replay.dimension);
    std::vector<CodedContact> coded;
    coded.reserve(frame.contacts.size());
    for (const ReplayContact& contact : frame.contacts) {
        const bool a_fixed = replay.bodies[contact.a].type == ReplayBodyType::fixed;
        const ReplayState* reference = state_of(frame, a_fixed ? contact.b : contact.a);
        if (!reference || !finite(*reference)) continue;
        CodedContact c{{contact.a, contact.b}};
        for (std::size_t i = 0; i < size; ++i) {
            const double place = (contact.position[i] - reference->position[i]) / contact_resolution;
            const double normal = contact.normal[i] / normal_resolution;
            if (!(std::abs(place) < 1e9) || !(std::abs(normal) < 1e9)) break;
            c.values[i] = static_cast<std::int32_t>(std::lround(place));
            c.values[size + i] = static_cast<std::int32_t>(std::lround(normal));
        }
        c.values[2 * size] = coded_impulse(contact.impulse);
        coded.push_back(c);
    }
    std::stable_sort(coded.begin(), coded.end(),
                     [](const CodedContact& x, const CodedContact& y) { return x.bodies < y.bodies; });
    return coded;
}

/// Columns: contacts in the frame, a, b, then the values. Pairs are written as differences along the list,
/// values as differences from the same contact (the k-th of its pair) in the recorded frame before.
std::vector<Column> contact_columns(const Replay& replay, std::size_t every) {
    const auto values = 2 * static_cast<std::size_t>(replay.dimension) + 1;
    std::vector<Column> columns(3 + values);
    std::vector<CodedContact> before;
    for (std::size_t f = 0; f < replay.frames.size(); f += every) {
        std::vector<CodedContact> now = coded_contacts(replay, replay.frames[f]);
        columns[0].push_back(static_cast<std::int32_t>(now.size()));
        std::size_t match = 0;
        BodyPair last{0, 0};
        for (const CodedContact& contact : now) {
            const auto [a, b] = contact.bodies;
            columns[1].push_back(a - std::get<0>(last));
            columns[2].push_back(b - (a == std::get<0>(last) ? std::get<1>(last) : a));
            last = contact.bodies;
            while (match < before.size() && before[match].bodies < contact.bodies) ++match;
            const bool known = match < before.size() && before[match].bodies == contact.bodies;
            for (std::size_t i = 0; i < values; ++i)
                columns[3 + i].push_back(contact.values[i] - (known ? before[match].values[i] : 0));
            if (known) ++match;
        }
        before = std::move(now);
    }
    return columns;
}

}  // namespace

ReplayVector start_position(const Replay& replay, std::size_t body) {
    for (const ReplayFrame& frame : replay.frames)
        if (const ReplayState* state = state_of(frame, body); state && finite(*state)) return state->position;
    return {};
}

ReplayData encode_motion(const Replay& replay) {
    const std::size_t frames = replay.frames.size();
    const std::size_t bodies = replay.bodies.size();
    const std::vector<Channel> channels = channels_of(replay.dimension);

    std::vector<std::vector<double>> values(channels.size(), std::vector<double>(bodies * frames));
    Column flags(bodies * frames);
    for (std::size_t b = 0; b < bodies; ++b) {
        const std::vector<ReplayState> history = history_of(replay, b);
        const ReplayVector start = start_position(replay, b);
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const double base = c < static_cast<std::size_t>(replay.dimension) ? start[c] : 0.0;
            const std::span<double> series(values[c].data() + b * frames, frames);
            for (std::size_t f = 0; f < frames; ++f) series[f] = channels[c].read(history[f]) - base;
            if (channels[c].name == std::string_view("angle")) unwrap(series, history, replay.step);
        }
        for (std::size_t f = 0; f < frames; ++f)
            if (const ReplayState* state = state_of(replay.frames[f], b))
                flags[b * frames + f] = 1 | state->awake << 1 | state->jumped << 2 | state->sensing << 3;
    }

    ColumnStream stream;
    nlohmann::json described = nlohmann::json::array();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        double largest = 0;
        for (const double v : values[c]) largest = std::max(largest, std::abs(v));
        const double scale = scale_for(channels[c].resolution, largest);
        Column column(bodies * frames);
        for (std::size_t i = 0; i < column.size(); ++i) column[i] = quantise(values[c][i], scale);
        values[c] = {};
        for (std::size_t b = 0; b < bodies; ++b)
            difference({column.data() + b * frames, frames}, channels[c].order);
        const int planes = stream.add(column);
        described.push_back(
            {{"name", channels[c].name}, {"scale", scale}, {"order", channels[c].order}, {"planes", planes}});
    }
    described.push_back({{"name", "flags"}, {"scale", 1}, {"order", 0}, {"planes", stream.add(flags)}});
    return {{{"channels", described}}, stream.finish()};
}

ReplayData encode_contacts(const Replay& replay) {
    const bool flat = replay.dimension == 2;
    const std::vector<std::string> names =
        flat ? std::vector<std::string>{"count", "a", "b", "x", "y", "nx", "ny", "impulse"}
             : std::vector<std::string>{"count", "a", "b", "x", "y", "z", "nx", "ny", "nz", "impulse"};
    for (std::size_t every = 1;;) {
        ColumnStream stream;
        nlohmann::json described = nlohmann::json::array();
        std::size_t total = 0;
        const std::vector<Column> columns = contact_columns(replay, every);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            described.push_back({{"name", names[c]}, {"planes", stream.add(columns[c])}});
            total = columns[c].size();
        }
        std::string text = stream.finish();
        if (text.size() > replay.contact_bytes && every < replay.frames.size()) {
            every *= std::bit_ceil(text.size() / std::max<std::size_t>(replay.contact_bytes, 1) + 1);
            continue;
        }
        return {{{"every", every},
                 {"total", total},
                 {"position_scale", contact_resolution},
                 {"normal_scale", normal_resolution},
                 {"impulse_unit", impulse_unit},
                 {"impulse_steps", impulse_steps},
                 {"columns", described}},
                std::move(text)};
    }
}

}  // namespace carom::io
