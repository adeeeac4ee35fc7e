#include "io/replay.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "carom/error.hpp"
#include "io/output_file.hpp"
#include "io/replay_data.hpp"
#include "io/replay_template.hpp"

namespace carom::io {
namespace {

using nlohmann::json;

double finite_or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

/// Seven digits: enough to draw and to read off.
double shortened(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.7g", finite_or_zero(value));
    return std::strtod(text, nullptr);
}

json vector_json(const ReplayVector& v, int dimension) {
    json list = json::array();
    for (int i = 0; i < dimension; ++i) list.push_back(finite_or_zero(v[i]));
    return list;
}

json points_json(const std::vector<ReplayVector>& points, int dimension) {
    json list = json::array();
    for (const ReplayVector& point : points) list.push_back(vector_json(point, dimension));
    return list;
}

struct GeometryWriter {
    int dimension;

    json operator()(const ReplayBall& ball) const { return {{"type", "ball"}, {"radius", ball.radius}}; }
    json operator()(const ReplayBox& box) const {
        return {{"type", "box"}, {"size", vector_json(box.size, dimension)}, {"rounding", box.rounding}};
    }
    json operator()(const ReplayCapsule& capsule) const {
        return {{"type", "capsule"},
                {"from", vector_json(capsule.from, dimension)},
                {"to", vector_json(capsule.to, dimension)},
                {"radius", capsule.radius}};
    }
    json operator()(const ReplayHull& hull) const {
        json result = {
            {"type", "hull"}, {"points", points_json(hull.points, dimension)}, {"rounding", hull.rounding}};
        if (dimension == 3) result["faces"] = hull.faces;
        return result;
    }
    json operator()(const ReplayCylinder& cylinder) const {
        return {{"type", "cylinder"}, {"radius", cylinder.radius}, {"height", cylinder.height}};
    }
    json operator()(const ReplayCone& cone) const {
        return {{"type", "cone"}, {"radius", cone.radius}, {"height", cone.height}};
    }
    json operator()(const ReplayPlane& plane) const {
        return {
            {"type", "plane"}, {"normal", vector_json(plane.normal, dimension)}, {"offset", plane.offset}};
    }
    json operator()(const ReplayGround& ground) const {
        json points = json::array();
        for (const ReplayVector& point : ground.points) {
            json& entry = points.emplace_back(json::array());
            for (int i = 0; i < dimension; ++i) entry.push_back(shortened(point[i]));
        }
        return {{"type", dimension == 2 ? "chain" : "mesh"},
                {dimension == 2 ? "points" : "vertices", std::move(points)},
                {dimension == 2 ? "segments" : "triangles", ground.facets},
                {"two_sided", ground.two_sided}};
    }
};

json shape_json(const ReplayShape& shape, int dimension) {
    json result = std::visit(GeometryWriter{dimension}, shape.geometry);
    result["center"] = vector_json(shape.center, dimension);
    if (dimension == 2)
        result["angle"] = 2 * std::atan2(shape.rotation[2], shape.rotation[3]);
    else
        result["rotation"] = shape.rotation;
    result["material"] = shape.material;
    if (shape.sensor) result["sensor"] = true;
    if (shape.one_way) result["one_way"] = vector_json(*shape.one_way, dimension);
    if (shape.surface_velocity != ReplayVector{})
        result["surface_velocity"] = vector_json(shape.surface_velocity, dimension);
    return result;
}

json body_json(const Replay& replay, std::size_t index) {
    static constexpr const char* types[] = {"fixed", "kinematic", "dynamic"};
    const ReplayBody& body = replay.bodies[index];
    json result = {{"name", body.name},
                   {"type", types[static_cast<int>(body.type)]},
                   {"mass", finite_or_zero(body.mass)},
                   {"center_of_mass", vector_json(body.center_of_mass, replay.dimension)},
                   {"start", vector_json(start_position(replay, index), replay.dimension)},
                   {"shapes", json::array()}};
    if (replay.dimension == 2)
        result["inertia"] = finite_or_zero(body.inertia[2]);
    else
        for (const double value : body.inertia) result["inertia"].push_back(finite_or_zero(value));
    for (const ReplayShape& shape : body.shapes)
        result["shapes"].push_back(shape_json(shape, replay.dimension));
    return result;
}

json header_json(const Replay& replay, json motion, json contacts) {
    json header = {{"carom_replay", 1},
                   {"dimension", replay.dimension},
                   {"name", replay.name},
                   {"step", replay.step},
                   {"frames", replay.frames.size()},
                   {"gravity", vector_json(replay.gravity, replay.dimension)},
                   {"bodies", json::array()},
                   {"links", json::array()},
                   {"energy", {{"kinetic", json::array()}, {"potential", json::array()}}},
                   {"motion", std::move(motion)},
                   {"contacts", std::move(contacts)}};
    for (std::size_t i = 0; i < replay.bodies.size(); ++i) header["bodies"].push_back(body_json(replay, i));
    for (const ReplayLink& link : replay.links)
        header["links"].push_back({{"type", link.type},
                                   {"a", link.a},
                                   {"b", link.b},
                                   {"anchor_a", vector_json(link.anchor_a, replay.dimension)},
                                   {"anchor_b", vector_json(link.anchor_b, replay.dimension)}});
    for (const ReplayFrame& frame : replay.frames) {
        header["energy"]["kinetic"].push_back(shortened(frame.kinetic));
        header["energy"]["potential"].push_back(shortened(frame.potential));
    }
    return header;
}

/// JSON that may stand in a script element: plain ASCII, and without the one character that could end it.
std::string page_json(const json& value) {
    const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text)
        if (c == '<')
            safe += "\\u003c";
        else
            safe += c;
    return safe;
}

void check_body(std::int64_t index, std::int64_t lowest, const Replay& replay, const std::string& place) {
    const auto count = static_cast<std::int64_t>(replay.bodies.size());
    if (index < lowest || index >= count)
        throw Error(place + ": " + std::to_string(index) + " is not a body (there are " +
                    std::to_string(count) + ")");
}

void check(const Replay& replay) {
    if (replay.dimension != 2 && replay.dimension != 3)
        throw Error("dimension: " + std::to_string(replay.dimension) + " is neither 2 nor 3");
    if (!(replay.step > 0) || !std::isfinite(replay.step))
        throw Error("step: " + std::to_string(replay.step) + " is not positive and finite");
    for (std::size_t i = 0; i < replay.links.size(); ++i) {
        const std::string place = "links[" + std::to_string(i) + "]";
        check_body(replay.links[i].a, -1, replay, place + ".a");
        check_body(replay.links[i].b, -1, replay, place + ".b");
    }
    for (std::size_t f = 0; f < replay.frames.size(); ++f) {
        const ReplayFrame& frame = replay.frames[f];
        const std::string place = "frames[" + std::to_string(f) + "]";
        if (frame.states.size() > replay.bodies.size())
            throw Error(place + ".states: " + std::to_string(frame.states.size()) + " are more than the " +
                        std::to_string(replay.bodies.size()) + " bodies");
        for (const ReplayContact& contact : frame.contacts) {
            check_body(contact.a, 0, replay, place + ".contacts.a");
            check_body(contact.b, 0, replay, place + ".contacts.b");
        }
    }
}

/// The page with each marker replaced by its text; markers stand in it once and in this order.
std::string filled(std::string_view page,
                   std::initializer_list<std::pair<std::string_view, std::string_view>> texts) {
    std::string result;
    for (const auto& [marker, text] : texts) {
        const std::size_t at = page.find(marker);
        if (at == std::string_view::npos)
            throw Error("the replay viewer is not built into this program (its page lacks " +
                        std::string(marker) + ")");
        result.append(page.substr(0, at)).append(text);
        page.remove_prefix(at + marker.size());
    }
    return result.append(page);
}

}  // namespace

ReplayRotation replay_rotation(double angle) { return {0, 0, std::sin(angle / 2), std::cos(angle / 2)}; }

std::string replay_html(const Replay& replay, std::string_view page) {
    check(replay);
    ReplayData motion = encode_motion(replay);
    ReplayData contacts = encode_contacts(replay);
    const std::string header =
        page_json(header_json(replay, std::move(motion.description), std::move(contacts.description)));
    return filled(
        page,
        {{"@carom-header@", header}, {"@carom-motion@", motion.text}, {"@carom-contacts@", contacts.text}});
}

void write_replay(const Replay& replay, const std::filesystem::path& path) {
    OutputFile file(path, "replay");
    file.write(replay_html(replay, replay_template()));
    file.finish();
}

}  // namespace carom::io
