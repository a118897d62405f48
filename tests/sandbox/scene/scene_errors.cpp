// The corpus of broken scenes: each must be refused at the right place, in words that help.
#include <catch2/catch.hpp>

#include "tests/sandbox/scene/reading.h"

using namespace shatterbox::sandbox::scene;

namespace {

struct Broken {
  const char* text;
  const char* place;    // file:line:column of the complaint
  const char* message;  // a part of it
  const char* hint;     // a part of how to mend it
};

const Broken kCorpus[] = {
    // Not TOML at all.
    {"[scene\n", "t.toml:1:", "", "this is not TOML"},
    {"[[body]]\nmaterial = \"glass\nkind = \"box\"\n", "t.toml:2:", "", "ends with its second quote"},
    {"[[body]]\nkind = \"plane\"\n[body]\nkind = \"box\"\n", "t.toml:3:", "", "double brackets, as [[body]]"},
    {"[scene]\nseconds = 1\nseconds = 2\n", "t.toml:3:", "seconds", ""},
    {"[[body]]\nkind = \"sphere\"\nposition = [0, 1\n", "t.toml:", "", "this is not TOML"},
    {"[scene]\nseconds = 3 m\n", "t.toml:2:", "", "this is not TOML"},
    {"[scene]\nseconds = .5\n", "t.toml:2:", "", "as in 0.5"},
    {"[scene]\ngravity = [0, -.5, 0]\n", "t.toml:2:", "", "as in 0.5"},
    // Unknown keys and tables.
    {"[scene]\nsecond = 3\n", "t.toml:2:1", "unknown key \"second\"", "did you mean \"seconds\"?"},
    {"[scene]\ngravty = [0,0,0]\n", "t.toml:2:1", "unknown key \"gravty\"", "did you mean \"gravity\"?"},
    {"[camera]\n  postion = [0,0,1]\n", "t.toml:2:3", "unknown key \"postion\"",
     "did you mean \"position\"?"},
    {"[sene]\nseconds = 3\n", "t.toml:1:2", "unknown key \"sene\"", "did you mean \"scene\"?"},
    {"[[bodies]]\nkind=\"sphere\"\n", "t.toml:1:3", "unknown key \"bodies\"", "keys here"},
    {"[[body]]\nkind = \"sphere\"\nradios = 1\n", "t.toml:3:1", "unknown key \"radios\"",
     "did you mean \"radius\"?"},
    {"[light]\nsum = [0,1,0]\n", "t.toml:2:1", "unknown key \"sum\"", "did you mean \"sun\"?"},
    {"[render]\nbackdrp = \"dark\"\n", "t.toml:2:1", "unknown key", "did you mean \"backdrop\"?"},
    {"[light]\npreset = \"evning\"\n", "t.toml:2:10", "evning", "did you mean \"evening\"?"},
    {"[[body]]\nkind = \"sphere\"\nrepeat = {count = 2, spaceing = 1}\n",
     "t.toml:3:", "unknown key \"spaceing\"", "did you mean \"spacing\"?"},
    // Wrong types.
    {"[scene]\nseconds = \"four\"\n", "t.toml:2:11", "seconds must be a number", ""},
    {"[scene]\nsteps_per_second = 240.5\n", "t.toml:2:20", "must be a whole number", ""},
    {"[scene]\ngravity = -9.81\n", "t.toml:2:11", "gravity must be three numbers", "write [x, y, z] in m/s2"},
    {"[scene]\ngravity = [0, -9.81]\n", "t.toml:2:11", "a list of 2", "[x, y, z]"},
    {"[scene]\ngravity = [0, \"down\", 0]\n", "t.toml:2:15", "y of gravity must be a number", ""},
    {"scene = 3\n", "t.toml:1:9", "scene must be a table", "[scene]"},
    {"[body]\nkind = \"sphere\"\n", "t.toml:1:1", "body must be a list of tables", "[[body]]"},
    {"[[camera]]\nfov = 3\n", "t.toml:1:1", "camera must be a table", "[camera]"},
    {"[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nbreakable = 1\n", "t.toml:4:13", "true or false", ""},
    {"[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nmaterial = 7\n", "t.toml:4:12", "must be a text",
     "quotes"},
    {"[[body]]\nkind = \"sphere\"\nrepeat = 5\n", "t.toml:3:10", "repeat must be a table", "count = 10"},
    {"[scene]\nseconds = 2020-01-01\n", "t.toml:2:11", "but is a date", ""},
    // Out of range, nan, inf.
    {"[scene]\nseconds = nan\n", "t.toml:2:11", "must be finite, but is nan", ""},
    {"[scene]\nseconds = inf\n", "t.toml:2:11", "must be finite, but is inf", ""},
    {"[scene]\ngravity = [0, -inf, 0]\n", "t.toml:2:15", "must be finite", ""},
    {"[scene]\nseconds = -1\n", "t.toml:2:11", "from 0.001 to 86400 s", ""},
    {"[scene]\nsteps_per_second = 0\n", "t.toml:2:20", "from 10 to 100000", ""},
    {"[[body]]\nkind = \"sphere\"\nradius = 0\n", "t.toml:3:10", "from 1e-09 to 1e+06 m", ""},
    {"[[material]]\nname = \"m\"\nlike = \"glass\"\npoisson = 0.7\n", "t.toml:4:11", "from 0 to 0.4999", ""},
    {"[[material]]\nname = \"m\"\nlike = \"glass\"\nrestitution = 1.5\n", "t.toml:4:15", "from 0 to 1", ""},
    {"[camera]\nfov = 400\n", "t.toml:2:7", "from 1 to 150 degrees", ""},
    {"[[body]]\nkind = \"sphere\"\nradius = 1e300\n", "t.toml:3:10", "from 1e-09 to 1e+06 m", ""},
    {"[[body]]\nkind = \"sphere\"\nrepeat = {count = 0}\n", "t.toml:3:", "from 1 to 100000", ""},
    {"[[body]]\nkind = \"sphere\"\nrepeat = {count = [1000, 1000, 1]}\n",
     "t.toml:3:", "more than 100000 copies", ""},
    {"[[body]]\nkind = \"sphere\"\nrepeat = {count = 1, layer = [100000, 100000]}\n",
     "t.toml:3:", "more than 100000 copies in a layer", ""},
    // Names.
    {"[[body]]\nname = \"a.b\"\nkind = \"sphere\"\n", "t.toml:2:8", "contains '.'", "--set NAME.key=value"},
    {"[[body]]\nname = \"a/0\"\nkind = \"sphere\"\n", "t.toml:2:8", "contains '/'", "name/0"},
    {"[[body]]\nname = \"c#5\"\nkind = \"sphere\"\n", "t.toml:2:8", "contains '#'", "letters, digits"},
    {"[[body]]\nname = \"x,y\"\nkind = \"sphere\"\n", "t.toml:2:8", "contains ','", "letters, digits"},
    {"[[body]]\nname = \"\"\nkind = \"sphere\"\n", "t.toml:2:8", "is empty", ""},
    {"[[body]]\nname = \"a\"\nkind = \"sphere\"\n[[body]]\nname = \"a\"\nkind = \"sphere\"\n", "t.toml:5:8",
     "the name \"a\" is taken", "the first is at t.toml:2:8"},
    {"[[material]]\nname = \"a\"\nlike = \"glass\"\n[[body]]\nname = \"a\"\nkind = \"sphere\"\n",
     "t.toml:5:8", "is taken", "share their names"},
    {"[[body]]\nkind = \"plane\"\n[[body]]\nname = \"body1\"\nkind = \"sphere\"\n", "t.toml:4:8",
     "the name \"body1\" is taken", "what is at t.toml:1:1 has no name and is called so"},
    {"[[body]]\nname = \"camera\"\nkind = \"sphere\"\n", "t.toml:2:8", "nothing can be named \"camera\"", ""},
    // Choices.
    {"[[body]]\nkind = \"spere\"\n", "t.toml:2:8", "unknown kind \"spere\"", "did you mean \"sphere\"?"},
    {"[[body]]\nkind = \"shell\"\nshape = \"slab\"\n", "t.toml:3:9", "\"slab\" is the shape of a solid",
     "write kind = \"solid\""},
    {"[[body]]\nkind = \"shell\"\nshape = \"vase\"\nwall = 0.01\n", "t.toml:4:1",
     "\"wall\" does not belong here", "is its thickness"},
    {"[[body]]\nkind = \"shell\"\nshape = \"pane\"\nsize = [0.3, 0.2]\n", "t.toml:4:8",
     "a pane has a width and a height", "write width = 0.3"},
    {"[[body]]\nkind = \"solid\"\nshape = \"bricks\"\n", "t.toml:1:1", "has no size",
     "the size of the whole wall"},
    {"[[body]]\nkind = \"solid\"\nshape = \"bricks\"\nsize = 0.5\n", "t.toml:4:8", "must be three numbers",
     ""},
    {"[[body]]\nkind = \"solid\"\nshape = \"bricks\"\nsize = [1, 1, 0.1]\nrotation = [0, 30, 0]\n",
     "t.toml:5:", "lies along x", "repeat and bond"},
    {"[[body]]\nkind = \"solid\"\nshape = \"bricks\"\nsize = [900, 900, 0.1]\n",
     "t.toml:4:", "more than 100000 bricks", ""},
    {"[[body]]\nkind = \"shell\"\nshape = \"sheet\"\nsize = [0.3, 0.2]\n", "t.toml:3:9",
     "a flat sheet is a pane", "shape = \"pane\""},
    {"[[body]]\nkind = \"solid\"\nshape = \"vase\"\nthickness = 0.005\n", "t.toml:4:1",
     "\"thickness\" does not belong here", "how thick a solid vase is, is its wall"},
    {"[[body]]\nkind = \"shell\"\nshape = \"bowl\"\nstrength = 1e9\n", "t.toml:4:1",
     "\"strength\" does not belong here", "[[material]]"},
    {"[[body]]\nkind = \"box\"\nsize = 1\nelongation = 0.2\n", "t.toml:4:1",
     "\"elongation\" does not belong here", "[[material]]"},
    {"[[body]]\nkind = \"shell\"\nshape = \"bowel\"\n", "t.toml:3:9", "unknown shape \"bowel\"",
     "did you mean \"bowl\"?"},
    {"[[body]]\nkind = \"sphere\"\nmaterial = \"glas\"\n", "t.toml:3:12", "there is no material \"glas\"",
     "did you mean \"glass\"?"},
    {"[[body]]\nkind = \"sphere\"\nlook = \"stel\"\n", "t.toml:3:8", "unknown look",
     "did you mean \"steel\"?"},
    {"[[body]]\nkind = \"sphere\"\ncolour = \"red\"\n", "t.toml:3:10", "\"red\" is no colour", "#b3202c"},
    {"[[material]]\nname = \"m\"\nlike = \"porcelan\"\n", "t.toml:3:8",
     "no material \"porcelan\" above to be like", "did you mean \"porcelain\"?"},
    {"[[material]]\nname = \"m\"\nlike = \"n\"\n[[material]]\nname = \"n\"\nlike = \"glass\"\n", "t.toml:3:8",
     "no material \"n\" above to be like", "materials: "},
    {"[[material]]\nname = \"m\"\n", "t.toml:1:1", "neither \"like\" nor \"density\"", "like = \"glass\""},
    {"[[material]]\nlike = \"glass\"\n", "t.toml:1:1", "needs a name", ""},
    {"[[pair]]\nbetween = [\"glass\"]\nfriction = 0.1\n", "t.toml:2:11", "names of two materials", ""},
    {"[[pair]]\nbetween = [\"glass\", \"steel\"]\n", "t.toml:1:1", "changes nothing",
     "friction or restitution"},
    {"[scene]\nstress_window = \"automatic\"\n", "t.toml:2:17", "stress_window cannot be", "\"auto\""},
    // What does not fit together.
    {"[[body]]\nname = \"x\"\n", "t.toml:1:1", "has no kind", "\"shell\""},
    {"[[body]]\nkind = \"shell\"\n", "t.toml:1:1", "neither a mesh nor a shape", "mesh = \"file.obj\""},
    {"[[body]]\nkind = \"box\"\n", "t.toml:1:1", "has no size", "size = [x, y, z]"},
    {"[[body]]\nkind = \"capsule\"\nradius = 0.2\nlength = 0.4\n", "t.toml:4:10",
     "is 0.4 m long with its round ends alone", "is a sphere"},
    {"[[body]]\nname = \"b\"\nkind = \"sphere\"\n[[event]]\nat = 1\ndo = \"drop\"\nbody = \"b\"\nheight = "
     "2\n",
     "t.toml:8:1", "\"height\" does not belong here", "falls from \"position\""},
    {"[[body]]\nkind = \"capsule\"\nsize = 1\n", "t.toml:3:1", "\"size\" does not belong here",
     "a radius and a length only"},
    {"[[body]]\nkind = \"sphere\"\nthickness = 1\n", "t.toml:3:1", "\"thickness\" does not belong here",
     "shell"},
    {"[[body]]\nkind = \"shell\"\nshape = \"pane\"\nradius = 1\n", "t.toml:4:1", "does not belong here",
     "no size of shape \"pane\""},
    {"[[body]]\nkind = \"plane\"\nmotion = \"dynamic\"\n", "t.toml:3:10", "a plane cannot fall", ""},
    {"[[body]]\nkind = \"sphere\"\nfixed = \"x\"\n", "t.toml:3:9", "fixed must be a list", "fixed = ["},
    {"[[body]]\nkind = \"sphere\"\nfixed = [1]\n", "t.toml:3:10", "an axis is a word", "fixed = ["},
    {"[[body]]\nkind = \"sphere\"\nfixed = [\"rq\"]\n", "t.toml:3:10", "unknown axis \"rq\"", "did you mean"},
    {"[[body]]\nkind = \"sphere\"\nfixed = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]\n", "t.toml:3:9",
     "all is fixed", "static"},
    {"[[body]]\nkind = \"sphere\"\nfixed = [\"y\"]\nvelocity = [0, 1, 0]\n", "t.toml:4:12",
     "velocity goes along an axis that is fixed", "set it to 0"},
    {"[[body]]\nkind = \"sphere\"\nfixed = [\"rz\"]\nangular_velocity = [0, 0, 1]\n", "t.toml:4:20",
     "angular_velocity goes about an axis that is fixed", "set it to 0"},
    {"[[body]]\nkind = \"plane\"\nfixed = [\"x\"]\n", "t.toml:3:1", "does not belong here", "dynamic"},
    {"[[body]]\nkind = \"plane\"\nvelocity = [1,0,0]\n", "t.toml:3:1", "does not belong here", "static"},
    {"[[body]]\nkind = \"shell\"\nshape = \"pane\"\nsupport = \"side\"\n", "t.toml:4:11", "unknown support",
     "\"edge\""},
    {"[[body]]\nkind = \"shell\"\nshape = \"pane\"\nsupport = {box = [[0,0,0]]}\n", "t.toml:4:11",
     "support cannot be", "box = [[x, y, z], [x, y, z]]"},
    {"[[body]]\nkind = \"shell\"\nshape = \"pane\"\nsupport = \"edge\"\nmotion = \"dynamic\"\n",
     "t.toml:5:10", "held by the world", ""},
    {"[[body]]\nkind = \"shell\"\nmesh = \"no_such.obj\"\n", "t.toml:3:8",
     "there is no mesh file no_such.obj", "beside the scene"},
    {"[[body]]\nkind = \"solid\"\nmesh = \"/usr/share/glmark2/no_such.obj\"\n", "t.toml:3:8",
     "there is no mesh file", "apt install glmark2-data"},
    {"[[body]]\nkind = \"sphere\"\nrotation = [0,0,1]\norientation = [1,0,0,0]\n", "t.toml:4:15", "not both",
     ""},
    {"[[body]]\nkind = \"sphere\"\norientation = [0,0,0,0]\n", "t.toml:3:15", "points nowhere", ""},
    {"[camera]\nposition = [1,1,1]\ntarget = [1,1,1]\n", "t.toml:3:10", "looks at itself", ""},
    {"[camera]\nposition = [0,1,0]\ntarget = [0,0,0]\n", "t.toml:3:10", "along its up direction", "tilt up"},
    {"[camera]\nposition = [0,1,0]\npath = [{at = 0}, {at = 0}]\n", "t.toml:3:", "forward in time", ""},
    {"[light]\nsun = [0,0,0]\n", "t.toml:2:7", "points nowhere", ""},
    // Scripted bodies.
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\n", "t.toml:3:10", "has no keyframes",
     "keyframes = [{at"},
    {"[[body]]\nkind = \"sphere\"\nkeyframes = [{at = 0}, {at = 1}]\n", "t.toml:3:1", "does not belong here",
     "motion = \"scripted\""},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nkeyframes = [{at = 0}]\n", "t.toml:4:13",
     "at least two keyframes", "static"},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nkeyframes = 1\n", "t.toml:4:13",
     "keyframes must be a list", "position = [0, 1, 0]"},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nkeyframes = [{at = 2}, {at = 1}]\n", "t.toml:4:30",
     "forward in time, but 1 s comes after 2 s", ""},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nkeyframes = [{at = 0}, {position = [0,1,0]}]\n",
     "t.toml:4:24", "needs a time", "at = 1.5"},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nkeyframes = [{at = 0}, {at = 1, postion = "
     "[0,1,0]}]\n",
     "t.toml:4:33", "unknown key \"postion\"", "\"position\""},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nvelocity = [1,0,0]\nkeyframes = [{at = 0}, {at = "
     "1}]\n",
     "t.toml:4:1", "does not belong here", "the path says"},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\npath = [{at = 0}, {at = 1}]\n", "t.toml:3:10",
     "has no keyframes", ""},
    {"[[body]]\nkind = \"plane\"\nmotion = \"scripted\"\nkeyframes = [{at = 0}, {at = 1, rotation = "
     "[9,0,0]}]\n",
     "t.toml:4:44", "a plane cannot turn", "box"},
    {"[[body]]\nkind = \"shell\"\nshape = \"pane\"\nbreakable = true\nmotion = \"scripted\"\nkeyframes = "
     "[{at = "
     "0}, "
     "{at = 1}]\n",
     "t.toml:4:13", "does not break", ""},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nkeyframes = [{at = 0}, {at = 1}]\nrepeat = {count "
     "= 2, "
     "every "
     "= 1}\n",
     "t.toml:5:10", "from the start", "every"},
    {"[scene]\ncontact = \"paper\"\n[[body]]\nkind = \"sphere\"\nmotion = \"scripted\"\nkeyframes = [{at = "
     "0}, "
     "{at = "
     "1}]\n",
     "t.toml:3:1", "the paper's contact does not know", ""},
    // Events.
    {"[[event]]\ndo = \"drop\"\nat = 1\n", "t.toml:1:1", "names no body", "body = \"name\""},
    {"[[event]]\nat = 1\ndo = \"drop\"\nbody = \"bal\"\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\n",
     "t.toml:4:8", "there is no body \"bal\"", "did you mean \"ball\"?"},
    {"[[body]]\nname = \"ball\"\nkind = \"sphere\"\nrepeat = {count = 3, spacing = [1, 0, 0]}\n[[event]]\nat "
     "= 1\n"
     "do = \"push\"\nbody = \"ball[4]\"\nimpulse = [1, 0, 0]\n",
     "t.toml:8:8", "there is no \"ball[4]\"", "ball[1] to ball[3]"},
    {"[[body]]\nname = \"ball\"\nkind = \"sphere\"\n[camera]\nfollow = \"ball[1x\"\n", "t.toml:5:10",
     "there is no \"ball[1x\"", "has no copies"},
    {"[[event]]\nat = 1\ndo = \"projectle\"\n", "t.toml:3:6", "unknown do", "did you mean \"projectile\"?"},
    {"[[event]]\nat = 1\n", "t.toml:1:1", "does nothing", ""},
    {"[[event]]\ndo = \"projectile\"\nfrom=[0,0,0]\nat_point=[1,0,0]\nspeed=1\n", "t.toml:1:1", "has no time",
     "at = 0.5"},
    {"[[event]]\nat=0\ndo = \"projectile\"\nat_point=[1,0,0]\nspeed=1\n", "t.toml:1:1", "has no \"from\"",
     ""},
    {"[[event]]\nat=0\ndo = \"projectile\"\nfrom=[0,0,0]\nspeed=1\n", "t.toml:1:1", "needs one target",
     "at_body"},
    {"[[event]]\nat=0\ndo = \"projectile\"\nfrom=[0,0,0]\nat_point=[0,0,0]\nspeed=1\n", "t.toml:5:10",
     "where the projectile starts", ""},
    {"[[event]]\nat=0\ndo=\"projectile\"\nfrom=[0,0,0]\nat_point=[1,0,0]\nspeed=1\nbody={kind=\"sphere\", "
     "repeat={count=5}}\n",
     "t.toml:7:", "a projectile is one body", "drop"},
    {"[[body]]\nname=\"b\"\nkind=\"sphere\"\nfixed=[\"y\"]\n[[event]]\nat=0\ndo=\"projectile\"\nbody=\"b\"\n"
     "from=[0,0,0]\nat_point=[1,1,0]\nspeed=1\n",
     "t.toml:8:6", "it is thrown along an axis that is fixed", "take the axis out of fixed"},
    {"[[body]]\nname=\"b\"\nkind=\"sphere\"\nfixed=[\"rx\"]\n[[event]]\nat=0\ndo=\"projectile\"\nbody=\"b\"\n"
     "from=[0,0,0]\nat_point=[1,0,0]\nspeed=1\nspin=[1,0,0]\n",
     "t.toml:8:6", "it is thrown with a spin about an axis that is fixed", "take the axis out of fixed"},
    {"[[body]]\nname=\"b\"\nkind=\"sphere\"\nfixed=[\"y\"]\n[[event]]\nat=0\ndo=\"push\"\nbody=\"b\"\n"
     "impulse=[0,1,0]\n",
     "t.toml:8:6", "it is pushed along axes that are fixed", "take the axis out of fixed"},
    {"[[event]]\nat=-1\ndo = \"projectile\"\nfrom=[0,0,0]\nat_point=[1,0,0]\nspeed=1\n", "t.toml:2:4",
     "from 0 to", ""},
    {"[[event]]\nat=0\ndo = \"drop\"\nspeed=1\nbody={kind=\"sphere\"}\n", "t.toml:4:1",
     "does not belong here", "projectile"},
    {"[[event]]\nat=0\ndo = \"drop\"\nbody={kind=\"sphere\", radius=-1}\n", "t.toml:4:", "from 1e-09", ""},
    {"[[event]]\nat=0\ndo = \"drop\"\nbody=\"floor\"\n[[body]]\nname=\"floor\"\nkind=\"plane\"\n",
     "t.toml:4:6", "is static and cannot be thrown", ""},
    {"[[event]]\nat=0\ndo = "
     "\"push\"\nbody=\"flor\"\nimpulse=[1,0,0]\n[[body]]\nname=\"floor\"\nkind=\"plane\"\n",
     "t.toml:4:6", "there is no body", "did you mean \"floor\"?"},
    {"[[event]]\nat=0\ndo = "
     "\"push\"\nbody=\"floor\"\nimpulse=[1,0,0]\n[[body]]\nname=\"floor\"\nkind=\"plane\"\n",
     "t.toml:4:6", "cannot be pushed", "dynamic"},
    {"[[event]]\nat=0\ndo = \"push\"\nbody=\"b\"\n[[body]]\nname=\"b\"\nkind=\"sphere\"\n", "t.toml:1:1",
     "has no \"impulse\"", "N s"},
    {"[[event]]\nat=0\ndo = \"remove\"\n[[body]]\nname=\"b\"\nkind=\"sphere\"\n", "t.toml:1:1",
     "names no body", "body = "},
    {"[[event]]\nat=0\ndo = \"remove\"\nbody=\"b\"\nimpulse=[1,0,0]\n[[body]]\nname=\"b\"\nkind=\"sphere\"\n",
     "t.toml:5:1", "does not belong here", "push"},
    {"[[body]]\nkind = \"solid\"\nshape = \"box\"\n", "t.toml:3:9", "is a slab", "shape = \"slab\""},
    {"[[body]]\nkind = \"shell\"\nshape = \"plate\"\n", "t.toml:3:9", "a low bowl", "shape = \"bowl\""},
    // Words of other programs, and units.
    {"[[body]]\nkind = \"sphere\"\npos = [0, 1, 0]\n", "t.toml:3:1", "unknown key \"pos\"", "\"position\"?"},
    {"[[body]]\nkind = \"sphere\"\nmass = 2\n", "t.toml:3:1", "does not belong here", "density in kg/m3"},
    {"[[body]]\nkind = \"sphere\"\nstatic = true\n", "t.toml:3:1", "does not belong here",
     "motion = \"static\""},
    {"[[event]]\nat = 1\ndo = \"explode\"\n", "t.toml:3:6", "unknown do", "\"explosion\"?"},
    {"[render]\nfps = 30\n", "t.toml:2:1", "does not belong here", "--fps 30"},
    {"[[body]]\nkind = \"sphere\"\nradius = 10cm\n", "t.toml:3:12", "expected digit", "10 cm are 0.1"},
    {"[[body]]\nkind = \"sphere\"\nradius = 0.5 cm\n", "t.toml:3:14", "expected", "10 cm are 0.1"},
    {"[[body]]\nkind = \"sphere\"\nradius = \n", "t.toml:3:", "", "not TOML"},
    {"[[body]]\nkind = \"shell\"\nshape = \"glass\"\n", "t.toml:3:9", "a high bowl",
     "shape = \"wine_glass\""},
    {"[[body]]\nkind = \"solid\"\nshape = \"wine_glass\"\n", "t.toml:3:9", "the shape of a shell",
     "kind = \"shell\""},
    {"[[body]]\nkind = \"solid\"\nshape = \"cylinder\"\n", "t.toml:3:9", "turned on a lathe", "profile = [["},
    {"[[body]]\nkind = \"solid\"\nshape = \"lathe\"\n", "t.toml:1:1", "has no profile", "profile = [["},
    {"[[body]]\nkind = \"solid\"\nshape = \"lathe\"\nprofile = [[0.1, 0], [0.1]]\n", "t.toml:4:22",
     "a radius and a height", "profile = [["},
    {"[[body]]\nkind = \"shell\"\nshape = \"lathe\"\nprofile = [[0.1, 0], [-0.1, 1]]\n", "t.toml:4:23",
     "the radius of a point", ""},
    {"[[body]]\nkind = \"shell\"\nshape = \"lathe\"\nprofile = [[0.1, 0], [0.1, 0]]\n", "t.toml:4:11",
     "point 2 of a lathe's profile is where", "from one end to the other"},
    {"[[material]]\nname = \"m\"\ngrain_direction = [0.1, 0, 0]\n", "t.toml:1:1", "from 1 to 100 long", ""},
    {"[[body]]\nkind = \"sphere\"\nrepeat = {count = 3, spacing = 1, bond = 0.5}\n", "t.toml:3:42",
     "only courses of a grid", "count = [12, 10, 1]"},
    {"[[body]]\nkind = \"sphere\"\nmaterial = \"wood\"\n", "t.toml:3:12", "along its grain",
     "look = \"wood\""},
    // Solids.
    {"[[body]]\nkind = \"solid\"\n", "t.toml:1:1", "has neither a mesh nor a shape", "\"slab\""},
    {"[[body]]\nkind = \"solid\"\nshape = \"slab\"\n", "t.toml:1:1", "has no size", "[x, y, z]"},
    {"[[body]]\nkind = \"solid\"\nshape = \"pane\"\n", "t.toml:3:9", "\"pane\"", "kind = \"shell\""},
    {"[[body]]\nkind = \"solid\"\nshape = \"slab\"\nsize = [1, 1, 1]\nthickness = 0.1\n", "t.toml:5:1",
     "does not belong here", "shell"},
    {"[[body]]\nkind = \"solid\"\nshape = \"sphere\"\nsupport = \"edge\"\n", "t.toml:4:1", "no open border",
     "foot"},
    {"[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nelement_size = 0.1\n", "t.toml:4:1",
     "does not belong here", "solid"},
    {"[[body]]\nkind = \"solid\"\nshape = \"sphere\"\nmotion = \"static\"\nelement_size = 0.1\n",
     "t.toml:5:1", "only a breakable solid", "breakable = true"},
    {"[[body]]\nkind = \"shell\"\nshape = \"sphere\"\ngrading = 2\n", "t.toml:4:1", "does not belong here",
     "solid"},
    {"[[body]]\nkind = \"solid\"\nshape = \"sphere\"\nmotion = \"static\"\ngrading = 2\n", "t.toml:5:1",
     "only a breakable solid", "breakable = true"},
    {"[[body]]\nkind = \"solid\"\nshape = \"sphere\"\ngrading = 3\n", "t.toml:4:1", "3 times as large",
     "2, 4 or 8"},
    {"[[body]]\nkind = \"sphere\"\nmotion = \"static\"\nforce = [1,0,0]\n", "t.toml:4:1",
     "\"force\" does not belong here", "motion = \"dynamic\""},
    {"[[event]]\ndo = \"speed\"\nfactor = 1\n", "t.toml:1:", "has no time", "first break"},
    {"[[event]]\nat = 1\nwhen = \"rest\"\ndo = \"speed\"\nfactor = 1\n", "t.toml:3:8",
     "both a time and a condition", "keep at"},
    {"[[event]]\nat = 1\nafter = 1\ndo = \"speed\"\nfactor = 1\n", "t.toml:3:9", "something to wait for",
     "at = 0.5"},
    {"[[event]]\nat = 1\nof = \"ball\"\ndo = \"speed\"\nfactor = 1\n[[body]]\nname = \"ball\"\n"
     "kind = \"sphere\"\n",
     "t.toml:3:6", "whose break is waited for", "add when"},
    {"[[event]]\nwhen = \"first break\"\nof = \"bal\"\ndo = \"speed\"\nfactor = 1\n[[body]]\n"
     "name = \"ball\"\nkind = \"sphere\"\n",
     "t.toml:3:6", "there is no body \"bal\"", "did you mean \"ball\"?"},
    {"[[event]]\nwhen = \"first brake\"\ndo = \"speed\"\nfactor = 1\n", "t.toml:2:8", "unknown when",
     "did you mean \"first break\"?"},
    {"[[event]]\nat = 1\ndo = \"camera\"\nmove = \"dolly\"\n", "t.toml:1:", "changes nothing",
     "position, target"},
    {"[[event]]\nat = 1\ndo = \"camera\"\nposition = [0,0,1]\nduration = 2\n", "t.toml:5:1",
     "\"duration\" does not belong here", "dolly"},
    {"[[event]]\nat = 1\ndo = \"camera\"\nmove = \"follow\"\nbody = \"bal\"\n[[body]]\nname = \"ball\"\n"
     "kind = \"sphere\"\n",
     "t.toml:5:8", "there is no body \"bal\"", "did you mean \"ball\"?"},
    {"[[event]]\nat = 1\ndo = \"overlay\"\nshow = \"strain\"\n", "t.toml:4:8", "unknown show", "\"stress\""},
    {"[[event]]\nat = 1\ndo = \"caption\"\ntext = \"caf\u00e9\"\n", "t.toml:4:8", "plain letters", ""},
    {"[camera]\nfollow = \"x\"\n[[body]]\nname = \"y\"\nkind = \"sphere\"\n", "t.toml:2:10",
     "there is no body \"x\"", "\"y\""},
    {"[[event]]\nat = 1\ndo = \"speed\"\n", "t.toml:1:", "has no \"factor\"", "factor = 0.1"},
    {"[[event]]\nat = 1\ndo = \"speed\"\nfactor = 0\n", "t.toml:4:10", "from 0.0001 to 100", ""},
    {"[[event]]\nat = 1\ndo = \"speed\"\nfactor = 1\nimpulse = [1,0,0]\n", "t.toml:5:1",
     "\"impulse\" does not belong here", "do = \"push\""},
    {"[[event]]\nat = 1\ndo = \"explosion\"\nenergy = 1\n", "t.toml:1:", "has no \"centre\"", "add centre"},
    {"[[event]]\nat = 1\ndo = \"explosion\"\ncentre = [0,0,0]\n", "t.toml:1:", "has no \"energy\"", "TNT"},
    {"[[event]]\nat = 1\ndo = \"explosion\"\ncentre = [0,0,0]\nenergy = 1\nduration = 1\n", "t.toml:6:12",
     "0.1 s", ""},
    {"[[event]]\nat = 1\ndo = \"projectile\"\nat_screen = [0.1]\nspeed = 1\n", "t.toml:4:13", "two numbers",
     "[right, up]"},
    {"[[event]]\nat = 1\ndo = \"gravity\"\n", "t.toml:1:", "has no \"gravity\"", "[0, -1.62, 0]"},
    {"[[event]]\nat = 1\ndo = \"grab\"\nbody = \"p\"\n[[body]]\nname = \"p\"\nkind = \"plane\"\n",
     "t.toml:4:8", "cannot be grabbed", "dynamic"},
    {"[[event]]\nat = 1\ndo = \"move\"\nbody = \"p\"\n[[body]]\nname = \"p\"\nkind = \"sphere\"\n",
     "t.toml:1:", "has no \"to\"", "where the hand goes"},
    // Joints.
    {"[[joint]]\n[[body]]\nname = \"a\"\nkind = \"box\"\n", "t.toml:1:1", "does not say between whom",
     "between = "},
    {"[[joint]]\nbetween = [\"a\", \"bb\"]\n[[body]]\nname = \"a\"\nkind = \"box\"\n", "t.toml:2:17",
     "there is no body \"bb\"", "\"a\""},
    {"[[joint]]\nbetween = [\"a\"]\nkind = \"point\"\nat = [0,0,0]\n[[body]]\nname = \"a\"\nkind = \"box\"\n",
     "t.toml:2:11", "holds a point of two bodies", "bead[2]"},
    {"[[joint]]\nbetween = [\"a[3]\", \"a[1]\"]\nkind = \"point\"\nat = [0,0,0]\n[[body]]\nname = \"a\"\n"
     "kind = \"sphere\"\nrepeat = {count = 2}\n",
     "t.toml:2:12", "there is no \"a[3]\"", "its copies are a[1] to a[2]"},
    {"[[joint]]\nbetween = [\"a\"]\nkind = \"point\"\nat = [0,0,0]\n[[body]]\nname = \"a\"\n"
     "kind = \"sphere\"\nrepeat = {count = 2}\n",
     "t.toml:4:1", "\"at\" does not belong here", "each copy holds the next half way between them"},
    {"[[joint]]\nbetween = [\"a\"]\nat = [0,0,0]\n[[body]]\nname = \"a\"\nkind = \"box\"\n", "t.toml:3:1",
     "\"at\" does not belong here", "point"},
    {"[[joint]]\nbetween = [\"a\"]\nstrength = 0\n[[body]]\nname = \"a\"\nkind = \"box\"\n", "t.toml:3:12",
     "greater than 0 Pa", ""},
    {"[scene]\ncontact = \"papre\"\n", "t.toml:2:11", "\"papre\"", "\"paper\""},
    {"[[material]]\nname = \"m\"\nlike = \"steel\"\nyield = -1\n", "t.toml:4:9", "yield", ""},
    // Bodies that contradict themselves.
    {"[[body]]\nkind = \"box\"\norientation = [1, 0, 0]\n", "t.toml:3:15", "must be four numbers",
     "[w, x, y, z]"},
    {"[[body]]\nkind = \"shell\"\nshape = \"bowl\"\nsupport = {box = [[0, 0], [1, 1, 1]]}\n",
     "t.toml:4:", "the first corner of the box", "[x, y, z]"},
    {"[[body]]\nkind = \"shell\"\nshape = \"bowl\"\nmesh = \"bowl.obj\"\n", "t.toml:3:9",
     "either a mesh or a shape, not both", "remove one"},
    {"[[body]]\nkind = \"shell\"\nshape = \"bowl\"\nscale = 2\nsize = [1, 1, 1]\n", "t.toml:5:8",
     "either a scale or a size, not both", "remove one"},
    {"[[body]]\nkind = \"box\"\nmotion = \"scripted\"\nkeyframes = [1, 2]\n", "t.toml:4:14",
     "must be a table", "write {at = 1.5"},
    {"[[body]]\nkind = \"box\"\nmotion = \"scripted\"\norientation = [1, 0, 0, 0]\nkeyframes = [{at = 0}, "
     "{at = "
     "1}]\n",
     "t.toml:4:1", "has angles, not an orientation", "rotation = [x, y, z]"},
    {"[[body]]\nkind = \"shell\"\nshape = \"bowl\"\nsupport = \"foot\"\nmotion = \"scripted\"\n"
     "keyframes = [{at = 0}, {at = 1}]\n",
     "t.toml:5:1", "cannot follow a path", "remove motion or support"},
    {"[[event]]\nat = 1\ndo = \"drop\"\nbody = {kind = \"sphere\", motion = \"scripted\", keyframes = [{at = "
     "0}, {at = 1}]}\n",
     "t.toml:4:", "events cannot bring it in", "first keyframe be later"},
    {"[[body]]\nkind = \"sphere\"\nrepeat = {count = [2, 2, 1], spacing = 1, layer = [2, 2]}\n",
     "t.toml:3:", "a grid has no layers", "count = 100, layer"},
    {"[[joint]]\nbetween = [\"a\", \"late\"]\n[[body]]\nname = \"a\"\nkind = \"box\"\n[[body]]\nname = "
     "\"late\"\n"
     "kind = \"box\"\n[[event]]\nat = 1\ndo = \"drop\"\nbody = \"late\"\n",
     "t.toml:2:17", "is not there from the start, and cannot be joined", "no event"},
    {"[scene]\ncontact = \"paper\"\n[[joint]]\nbetween = [\"a\"]\n[[body]]\nname = \"a\"\nkind = \"box\"\n"
     "repeat = {count = 2, spacing = [1, 0, 0]}\n",
     "t.toml:3:", "the paper's contact knows no joints", "remove contact"},
    // Cameras that see nothing.
    {"[camera]\nfollow = \"a\"\noffset = [0, 0, 0]\n[[body]]\nname = \"a\"\nkind = \"box\"\n", "t.toml:3:1",
     "cannot be where it looks at", "[0, 0.3, 1]"},
    {"[camera]\nup = [0, 0, 0]\n[[body]]\nkind = \"box\"\n", "t.toml:2:6", "points nowhere", "[0, 1, 0]"},
    {"[[event]]\nat = 1\ndo = \"camera\"\nposition = [1, 1, 1]\ntarget = [1, 1, 1]\n[[body]]\nkind = "
     "\"box\"\n",
     "t.toml:5:1", "the camera looks at itself", "move position or target"},
    {"[[event]]\nat = 1\ndo = \"camera\"\nmove = \"follow\"\nbody = \"a\"\noffset = [0, 0, "
     "0]\n[[body]]\nname = "
     "\"a\"\nkind = \"box\"\n",
     "t.toml:6:1", "cannot be where it looks at", "[0, 0.3, 1]"},
    {"", "t.toml", "the scene has no body", "[[body]]"},
    {"\n[[event]]\nat = 1\ndo = \"push\"\nbody = \"a\"\n", "t.toml:2:3", "events alone are a script",
     "shatterbox run SCENE --script t.toml"},
};

}  // namespace

TEST_CASE("each broken scene is refused at its place, with a way to mend it") {
  for (const Broken& broken : kCorpus) {
    const Reading reading = read(broken.text);
    INFO("scene:\n" << broken.text << "\nsaid:\n" << reading.text);
    CHECK_FALSE(reading.scene.has_value());
    REQUIRE_FALSE(reading.problems.empty());
    bool is_told = false;
    for (const Problem& problem : reading.problems) {
      const std::string place = describe(problem.place);
      is_told = is_told || (place.rfind(broken.place, 0) == 0 &&
                            problem.message.find(broken.message) != std::string::npos &&
                            problem.hint.find(broken.hint) != std::string::npos);
    }
    INFO("expected " << broken.place << ": ..." << broken.message << "... / ..." << broken.hint << "...");
    CHECK(is_told);
  }
}

TEST_CASE("one fault is told once") {
  const std::string push =
      "[[body]]\nname = \"b\"\nkind = \"sphere\"\n[[event]]\nat = 0\ndo = \"push\"\nbody = \"b\"\nimpulse = ";
  const std::string one_fault[] = {"[[body]]\nkind = \"sphere\"\nradius = -1\n", push + "[1, 0]\n",
                                   push + "[0, 0, 0]\n"};
  for (const std::string& text : one_fault) {
    const Reading reading = read(text);
    INFO(reading.text);
    CHECK(reading.problems.size() == 1);
  }
  CHECK(read(push + "[1, 0, 0]\n").problems.empty());
}

TEST_CASE("several faults are told at once, in the order of the text") {
  const Reading reading = read(
      "[scene]\nsecond = 1\nsteps_per_second = 1\n[[body]]\nkind = \"sphere\"\nradius = nan\n"
      "material = \"glas\"\n[camera]\nfov = \"wide\"\n");
  REQUIRE(reading.problems.size() == 5);
  const auto line = [&reading](const char* part) { return reading.text.find(part); };
  CHECK(line("t.toml:2:1") < line("t.toml:3:20"));
  CHECK(line("t.toml:3:20") < line("t.toml:6:10"));
  CHECK(line("t.toml:6:10") < line("t.toml:7:12"));
  CHECK(line("t.toml:7:12") < line("t.toml:9:7"));
}
