#pragma once

namespace carom::detail {

/// Visits the nodes of Gauss's quadrature between two limits: `visit(x, weight)`. With its twelve nodes it is
/// exact for polynomials up to degree 23.
template <class Visit>
void each_node(double from, double to, const Visit& visit) {
    struct Node {
        double x, weight;
    };
    constexpr Node nodes[] = {
        {0.98156063424671924, 0.047175336386511828}, {0.90411725637047491, 0.10693932599531843},
        {0.76990267419430469, 0.16007832854334622},  {0.58731795428661748, 0.20316742672306592},
        {0.36783149899818018, 0.23349253653835481},  {0.12523340851146891, 0.24914704581340277}};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    for (const Node& node : nodes) {
        visit(middle - half * node.x, half * node.weight);
        visit(middle + half * node.x, half * node.weight);
    }
}

}  // namespace carom::detail
