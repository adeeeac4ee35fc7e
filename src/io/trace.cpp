#include "io/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "carom/error.hpp"
#include "io/json_reader.hpp"

namespace carom::io {
namespace {

template <class Number>
void append(std::string& text, Number number) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text.append(digits.data(), end);
}

void append_vector(std::string& text, const Vec2& v) {
    for (const double number : {v.x, v.y}) append(text += ',', number);
}

void append_vector(std::string& text, const Vec3& v) {
    for (const double number : {v.x, v.y, v.z}) append(text += ',', number);
}

void append_state(std::string& text, const World<2>& world, BodyId<2> body) {
    append_vector(text, world.center_of_mass(body));
    append(text += ',', world.angle(body));
    append_vector(text, world.velocity(body));
    append(text += ',', world.angular_velocity(body));
}

void append_state(std::string& text, const World<3>& world, BodyId<3> body) {
    append_vector(text, world.center_of_mass(body));
    const Rotation3 q = world.rotation(body);
    for (const double number : {q.x, q.y, q.z, q.w}) append(text += ',', number);
    append_vector(text, world.velocity(body));
    append_vector(text, world.angular_velocity(body));
}

/// A field of comma-separated values (RFC 4180): in quotation marks where it holds what parts fields.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
    return quoted + '"';
}

template <int D>
std::vector<std::string> labels_of(const SceneWorld<D>& scene) {
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        labels.push_back(body_label(scene.world.name(scene.bodies[i]), i));
    return labels;
}

void require_bodies(std::span<const std::string> selected, const std::vector<std::string>& labels) {
    const std::vector<std::string_view> known(labels.begin(), labels.end());
    for (const std::string& name : selected)
        if (std::find(labels.begin(), labels.end(), name) == labels.end())
            throw Error(fmt::format("--trace-bodies: \"{}\" is not a body of this scene{}", name,
                                    suggestion(name, known)));
}

}  // namespace

template <int D>
Trace<D>::Trace(const std::filesystem::path& path, const SceneWorld<D>& scene,
                std::span<const std::string> selected)
    : file_(path, "trace") {
    const std::vector<std::string> labels = labels_of(scene);
    require_bodies(selected, labels);
    for (std::size_t i = 0; i < labels.size(); ++i)
        if (selected.empty() || std::find(selected.begin(), selected.end(), labels[i]) != selected.end())
            rows_.push_back({scene.bodies[i], csv_field(labels[i])});
    file_.write(D == 2 ? "step,time,body,x,y,angle,vx,vy,w\n"
                       : "step,time,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n");
}

template <int D>
void Trace<D>::write_step(const World<D>& world) {
    text_.clear();
    for (const Row& row : rows_) {
        append(text_, world.steps());
        append(text_ += ',', world.time());
        text_.append(",").append(row.label);
        append_state(text_, world, row.body);
        text_ += '\n';
    }
    file_.write(text_);
}

template class Trace<2>;
template class Trace<3>;

}  // namespace carom::io
