#!/bin/sh
# Which peers are here: their names go to stdout, a line about each that isn't to stderr. With an argument: whether that one is.
set -eu

# A line a peer: its name | what to call it | what compiles where it is | pkg-config's name, if it has one | Debian's package
peers() {
    cat <<'PEERS'
chipmunk | Chipmunk 7 | #include <chipmunk/chipmunk.h> | | libchipmunk-dev
box2d | Box2D 2.4 | #include <box2d/b2_distance_joint.h> | box2d | libbox2d-dev
bullet | Bullet | #include <BulletSoftBody/btSoftBody.h> | bullet | libbullet-dev
ode | ODE | #include <ode/ode.h> | ode | libode-dev
odeint | Boost.odeint | #include <boost/numeric/odeint.hpp> | | libboost-dev
gsl | GSL | #include <gsl/gsl_odeiv2.h> | gsl | libgsl-dev
sundials | SUNDIALS 6 | #include <arkode/arkode_erkstep.h>\n#if SUNDIALS_VERSION_MAJOR != 6\n#error\n#endif | | libsundials-dev
PEERS
}

peers | while IFS='|' read -r name title include package debian; do
    name=$(echo "$name" | tr -d ' ')
    package=$(echo "$package" | tr -d ' ')
    [ -z "${1-}" ] || [ "$1" = "$name" ] || continue
    flags=
    [ -z "$package" ] || flags=$(pkg-config --cflags "$package" 2>/dev/null) || true
    # Unquoted on purpose: a list of words.
    if printf '%b\n' "$include" | ${CXX:-c++} -x c++ $flags -fsyntax-only - 2>/dev/null; then
        [ -n "${1-}" ] || echo "$name"
    else
        [ -z "${1-}" ] || exit 1
        echo "steadfast: no $(echo $title) here: its rows are left out; to have them type: make deps-peers" \
             "(Debian: $(echo $debian))" >&2
    fi
done
