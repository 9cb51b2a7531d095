// Boost.odeint: header-only steppers, inlined into this file; states are vectors, or arrays for one body at a time.
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_m4_mclachlan.hpp>
#include <boost/version.hpp>

#include "ode_state.h"

namespace {

namespace odeint = boost::numeric::odeint;

enum variant { EULER, RK4, DOPRI5, CASH_KARP54, FEHLBERG78, BULIRSCH_STOER, RKN_M4, RKN_SB3A };

struct solver {
    virtual ~solver() = default;
    virtual void advance(double duration) = 0;
    virtual void read(double *position, double *velocity) const = 0;
};

// ---- free flight, in float: groups of bodies, x and v in vectors of their own or in one ------------------------------------

typedef std::vector<float> floats;

struct flight : solver {
    const workload *w;
    const method *m;
    float step;
    struct group {
        floats x, v, y; // y: x, then v, for RK4
    };
    std::vector<group> groups;
    odeint::symplectic_euler<floats, floats, float> euler;
    odeint::runge_kutta4<floats, float, floats, float> rk4;

    flight(const workload *work, const method *way, double dt) : w(work), m(way), step(float(dt))
    {
        std::vector<double> y(2 * w->dimensions * w->count);
        ode_load(w, m, y.data());
        for (size_t first = 0; first < w->count; first += ode_group(w, m, first)) {
            const auto begin = y.begin() + std::ptrdiff_t(2 * w->dimensions * first);
            const auto half = std::ptrdiff_t(w->dimensions * ode_group(w, m, first));
            groups.emplace_back();
            if (m->variant == EULER) {
                groups.back().x.assign(begin, begin + half);
                groups.back().v.assign(begin + half, begin + 2 * half);
            } else {
                groups.back().y.assign(begin, begin + 2 * half);
            }
        }
    }

    // a = g - k v; the same loop for both methods.
    void accelerate(const float *v, float *a, size_t length) const
    {
        const size_t count = length / w->dimensions;
        for (unsigned d = 0; d < w->dimensions; d++) {
            const float g = d == 1 ? float(-w->gravity) : 0, drag = float(w->drag);
            for (size_t i = d * count; i < (d + 1) * count; i++)
                a[i] = g - drag * v[i];
        }
    }

    void advance(double duration) override
    {
        for (group &g : groups)
            for (long i = std::lround(duration / double(step)); i > 0; i--)
                if (m->variant == EULER) {
                    // The stepper moves the first of the pair by f(second), then the second by f(first): v comes first, so that
                    // x moves by the new v; the acceleration asks for v, and not for x.
                    euler.do_step(std::make_pair([&](const floats &, floats &a) { accelerate(g.v.data(), a.data(), a.size()); },
                                                 [](const floats &v, floats &rate) { rate = v; }),
                                  g.v, g.x, 0.0f, step);
                } else {
                    rk4.do_step(
                        [this](const floats &y, floats &rates, float) {
                            const size_t half = y.size() / 2;
                            std::copy(y.begin() + std::ptrdiff_t(half), y.end(), rates.begin());
                            accelerate(y.data() + half, rates.data() + half, half);
                        },
                        g.y, 0.0f, step);
                }
    }

    void read(double *position, double *velocity) const override
    {
        std::vector<double> y;
        for (const group &g : groups)
            for (const floats *part : {&g.x, &g.v, &g.y})
                y.insert(y.end(), part->begin(), part->end());
        ode_store(w, m, y.data(), position, velocity);
    }
};

// ---- the race, in double ---------------------------------------------------------------------------------------------------

// One body at a time, in an array, or all in a vector: a state of `count` bodies at y + offset.
template <workload_kind kind, bool one> struct shape {
    static const size_t dimensions = kind == KEPLER ? 2 : 1;
    typedef typename std::conditional<one, std::array<double, 2 * dimensions>, std::vector<double>>::type state;
    typedef typename std::conditional<one, std::array<double, dimensions>, std::vector<double>>::type half;

    static void size(std::vector<double> &y, size_t length) { y.resize(length); }
    template <size_t N> static void size(std::array<double, N> &, size_t) {}
};

template <workload_kind kind, bool one> struct race : solver {
    typedef shape<kind, one> form;
    typedef typename form::state state;
    typedef typename form::half half;

    const workload *w;
    const method *m;
    double setting;
    std::vector<double> y;

    race(const workload *work, const method *way, double value)
        : w(work), m(way), setting(value), y(2 * form::dimensions * w->count)
    {
        ode_load(w, m, y.data());
    }
    void read(double *position, double *velocity) const override { ode_store(w, m, y.data(), position, velocity); }

    size_t bodies() const { return one ? 1 : w->count; }

    // Copied from static memory, which is 0: gcc would warn of odeint's arrays that are copied before they are set.
    template <class stepper> void controlled(size_t first, double duration)
    {
        static stepper blank;
        adaptive(first, duration, odeint::make_controlled(setting, setting, blank));
    }

    template <class stepper> void adaptive(size_t first, double duration, stepper step)
    {
        state s;
        form::size(s, 2 * form::dimensions * bodies());
        double *at = y.data() + 2 * form::dimensions * first;
        std::copy(at, at + s.size(), s.begin());
        odeint::integrate_adaptive(
            step,
            [this, first](const state &x, state &rates, double) {
                ode_rates(w, kind, first, bodies(), x.data(), rates.data());
            },
            s, 0.0, duration, 0.01);
        std::copy(s.begin(), s.end(), at);
    }

    template <class stepper> void symplectic(size_t first, double duration, stepper step)
    {
        const size_t length = form::dimensions * bodies();
        std::pair<half, half> s;
        form::size(s.first, length);
        form::size(s.second, length);
        double *at = y.data() + 2 * form::dimensions * first;
        std::copy(at, at + length, s.first.begin());
        std::copy(at + length, at + 2 * length, s.second.begin());
        odeint::integrate_n_steps(
            step,
            [this, first](const half &x, half &a) {
                ode_accelerations(w, kind, first, bodies(), x.data(), nullptr, a.data());
            },
            s, 0.0, setting, size_t(std::lround(duration / setting)));
        std::copy(s.first.begin(), s.first.end(), at);
        std::copy(s.second.begin(), s.second.end(), at + length);
    }

    void advance(double duration) override
    {
        for (size_t first = 0; first < w->count; first += one ? 1 : w->count)
            switch (variant(m->variant)) {
            case DOPRI5:
                controlled<odeint::runge_kutta_dopri5<state>>(first, duration);
                break;
            case CASH_KARP54:
                controlled<odeint::runge_kutta_cash_karp54<state>>(first, duration);
                break;
            case FEHLBERG78:
                controlled<odeint::runge_kutta_fehlberg78<state>>(first, duration);
                break;
            case BULIRSCH_STOER:
                adaptive(first, duration, odeint::bulirsch_stoer<state>(setting, setting));
                break;
            case RKN_M4:
                symplectic(first, duration, odeint::symplectic_rkn_sb3a_m4_mclachlan<half>());
                break;
            case RKN_SB3A:
                symplectic(first, duration, odeint::symplectic_rkn_sb3a_mclachlan<half>());
                break;
            case EULER:
            case RK4:
                break;
            }
    }
};

void *create(const workload *w, const method *m, double setting)
{
    if (w->kind == FLIGHT)
        return static_cast<solver *>(new flight(w, m, setting));
    if (w->kind == KEPLER)
        return m->group == 1 ? static_cast<solver *>(new race<KEPLER, true>(w, m, setting))
                             : static_cast<solver *>(new race<KEPLER, false>(w, m, setting));
    return m->group == 1 ? static_cast<solver *>(new race<OSCILLATORS, true>(w, m, setting))
                         : static_cast<solver *>(new race<OSCILLATORS, false>(w, m, setting));
}

void advance(void *self, double duration) { static_cast<solver *>(self)->advance(duration); }
void read(const void *self, double *position, double *velocity) { static_cast<const solver *>(self)->read(position, velocity); }
void destroy(void *self) { delete static_cast<solver *>(self); }

void version(char *text, size_t size)
{
    std::snprintf(text, size, "%d.%d.%d", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100);
}

method way(const char *name, unsigned workloads, variant which, size_t group)
{
    method m = {};
    m.name = name;
    m.workloads = workloads;
    m.dimensions = 3;
    m.order = which == EULER ? 1 : 4;
    m.adaptive = which >= DOPRI5 && which <= BULIRSCH_STOER;
    m.group = group;
    m.variant = which;
    return m;
}

const method *methods()
{
    static const method list[] = {
        way("symplectic_euler", DOES_FLIGHT, EULER, 0),
        way("symplectic_euler, 1,000 a state", DOES_FLIGHT, EULER, 1000),
        way("runge_kutta4", DOES_FLIGHT, RK4, 0),
        way("runge_kutta4, 1,000 a state", DOES_FLIGHT, RK4, 1000),
        way("dopri5, all in one", DOES_RACE, DOPRI5, 0),
        way("dopri5, one by one", DOES_RACE, DOPRI5, 1),
        way("cash_karp54, all in one", DOES_RACE, CASH_KARP54, 0),
        way("cash_karp54, one by one", DOES_RACE, CASH_KARP54, 1),
        way("fehlberg78, all in one", DOES_RACE, FEHLBERG78, 0),
        way("fehlberg78, one by one", DOES_RACE, FEHLBERG78, 1),
        way("bulirsch_stoer, all in one", DOES_RACE, BULIRSCH_STOER, 0),
        way("bulirsch_stoer, one by one", DOES_RACE, BULIRSCH_STOER, 1),
        way("symplectic_rkn_sb3a_m4, all in one", DOES_RACE, RKN_M4, 0),
        way("symplectic_rkn_sb3a_m4, one by one", DOES_RACE, RKN_M4, 1),
        way("symplectic_rkn_sb3a, all in one", DOES_RACE, RKN_SB3A, 0),
        way("symplectic_rkn_sb3a, one by one", DOES_RACE, RKN_SB3A, 1),
        method()};
    return list;
}

} // namespace

extern "C" {
extern const peer peer_odeint;
const peer peer_odeint = {
    "odeint", "libboost-dev", "float, race double", false,
    "std::vector in one state, or 1,000 bodies a state so that RK4's stages stay in cache; one by one: std::array.\n"
    "Header-only: built like the right-hand sides, for this very processor",
    version, methods, create, advance, read, destroy};
}
