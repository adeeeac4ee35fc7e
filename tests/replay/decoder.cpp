#include "decoder.hpp"

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>

namespace carom::io {
namespace {

using nlohmann::json;

std::string between(const std::string& page, const std::string& tag) {
    const std::size_t begin = page.find("<" + tag + ">") + tag.size() + 2;
    return page.substr(begin, page.find("</" + tag + ">") - begin);
}

std::vector<std::uint8_t> from_base64(const std::string& text) {
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        const std::size_t digit = digits.find(c);
        if (digit == std::string::npos) throw std::runtime_error("not base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
    }
    return bytes;
}

std::vector<std::uint8_t> inflated(const std::vector<std::uint8_t>& packed) {
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::runtime_error("inflateInit");
    stream.next_in = const_cast<std::uint8_t*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint8_t> chunk(1 << 16);
    int status = Z_OK;
    while (status == Z_OK) {
        stream.next_out = chunk.data();
        stream.avail_out = static_cast<uInt>(chunk.size());
        status = inflate(&stream, Z_NO_FLUSH);
        bytes.insert(bytes.end(), chunk.begin(), chunk.end() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("the zlib stream is not whole");
    return bytes;
}

class Columns {
  public:
    explicit Columns(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

    std::vector<std::int32_t> next(int planes, std::size_t length) {
        std::vector<std::int32_t> values;
        for (std::size_t i = 0; i < length; ++i) {
            std::uint32_t zigzag = 0;
            for (std::size_t p = 0; p < static_cast<std::size_t>(planes); ++p)
                zigzag |= static_cast<std::uint32_t>(bytes_.at(at_ + p * length + i)) << (8 * p);
            values.push_back(static_cast<std::int32_t>(zigzag >> 1 ^ (~(zigzag & 1) + 1)));
        }
        at_ += static_cast<std::size_t>(planes) * length;
        return values;
    }
    bool at_end() const { return at_ == bytes_.size(); }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

void decode_motion(Decoded& decoded, const std::string& text) {
    const std::size_t frames = decoded.header["frames"];
    const std::size_t bodies = decoded.header["bodies"].size();
    Columns columns(inflated(from_base64(text)));
    for (const json& channel : decoded.header["motion"]["channels"]) {
        std::vector<std::int32_t> values = columns.next(channel["planes"], bodies * frames);
        for (int k = 0; k < channel["order"].get<int>(); ++k)
            for (std::size_t i = 0; i < values.size(); ++i)
                if (i % frames != 0)
                    values[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(values[i]) +
                                                          static_cast<std::uint32_t>(values[i - 1]));
        std::vector<double>& numbers = decoded.channels[channel["name"]];
        for (const std::int32_t v : values) numbers.push_back(v * channel["scale"].get<double>());
    }
    if (!columns.at_end()) throw std::runtime_error("there is more motion than the header tells");
}

void decode_contacts(Decoded& decoded, const std::string& text) {
    const json& about = decoded.header["contacts"];
    const std::size_t dimension = decoded.header["dimension"];
    const std::size_t every = about["every"], total = about["total"];
    const std::size_t recorded = (decoded.header["frames"].get<std::size_t>() + every - 1) / every;
    Columns columns(inflated(from_base64(text)));
    std::map<std::string, std::vector<std::int32_t>> column;
    std::vector<std::string> names;
    for (const json& one : about["columns"]) {
        names.push_back(one["name"]);
        column[names.back()] = columns.next(one["planes"], names.back() == "count" ? recorded : total);
    }
    if (!columns.at_end()) throw std::runtime_error("there are more contacts than the header tells");

    std::map<std::tuple<int, int, int>, std::size_t> before;  // by a, b and which of the pair
    std::size_t i = 0;
    for (std::size_t frame = 0; frame < recorded; ++frame) {
        std::map<std::tuple<int, int, int>, std::size_t> now;
        std::vector<DecodedContact>& list = decoded.contacts.emplace_back();
        int last_a = 0, last_b = 0;
        for (const std::size_t end = i + static_cast<std::size_t>(column["count"][frame]); i < end; ++i) {
            const int a = last_a + column["a"][i];
            const int b = column["b"][i] + (a == last_a ? last_b : a);
            int which = 0;
            while (now.count({a, b, which})) ++which;
            now[{a, b, which}] = i;
            if (const auto found = before.find({a, b, which}); found != before.end())
                for (std::size_t c = 3; c < names.size(); ++c)
                    column[names[c]][i] += column[names[c]][found->second];
            DecodedContact contact{a, b, {}, {}, 0};
            const std::size_t reference =
                static_cast<std::size_t>(decoded.header["bodies"][a]["type"] == "fixed" ? b : a);
            for (std::size_t axis = 0; axis < dimension; ++axis) {
                contact.position.push_back(decoded.place(static_cast<int>(axis), reference, frame * every) +
                                           column[names[3 + axis]][i] *
                                               about["position_scale"].get<double>());
                contact.normal.push_back(column[names[3 + dimension + axis]][i] *
                                         about["normal_scale"].get<double>());
            }
            contact.impulse = about["impulse_unit"].get<double>() *
                              (std::exp2(column["impulse"][i] / about["impulse_steps"].get<double>()) - 1);
            list.push_back(contact);
            last_a = a;
            last_b = b;
        }
        before = std::move(now);
    }
}

}  // namespace

double Decoded::value(const std::string& channel, std::size_t body, std::size_t frame) const {
    return channels.at(channel).at(body * header["frames"].get<std::size_t>() + frame);
}

double Decoded::place(int axis, std::size_t body, std::size_t frame) const {
    return header["bodies"][body]["start"][static_cast<std::size_t>(axis)].get<double>() +
           value(std::string(1, "xyz"[axis]), body, frame);
}

Decoded decode(const std::string& page) {
    Decoded decoded;
    decoded.header = json::parse(between(page, "head"));
    decode_motion(decoded, between(page, "motion"));
    decode_contacts(decoded, between(page, "contacts"));
    return decoded;
}

}  // namespace carom::io
