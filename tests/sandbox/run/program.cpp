// The program from outside: exit statuses, outputs, what it says of wrong input.
#include <catch2/catch.hpp>

#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox::run;

TEST_CASE("exit status 2 and a word that helps for wrong input") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  folder.write("bad.toml", "[scene]\nsecond = 1\n[[body]]\nkind = \"sphere\"\n");
  const auto refused = [&folder](const std::string& arguments, const std::string& part) {
    const Outcome outcome = program(folder, arguments);
    INFO(arguments << "\n" << outcome.out << outcome.err);
    CHECK(outcome.status == 2);
    CHECK((outcome.err + outcome.out).find(part) != std::string::npos);
  };
  refused("", "");
  refused("runn good.toml", "did you mean \"run\"?");
  refused("good.toml", "it is a scene: shatterbox run good.toml");
  refused("run good.toml --reprot r.json", "did you mean \"--report\"?");
  refused("run good.toml --size=64x48 --qualty=full", "did you mean \"--quality\"?");
  refused("check good.toml --report r.json", "check has no option --report");
  refused("run good.toml again", "again is one word too many for run");
  refused("golden chek g", "did you mean \"check\"?");
  refused("golden make g --reasn x", "did you mean \"--reason\"?");
  refused("study", "study needs a NAME");
  refused("study moton", "did you mean \"motion\"?");
  refused("study motion -o good.toml", "good.toml");
  refused("diff one.png", "ACTUAL");
  refused("diff none.png none.png", "none.png: there is no such file");
  refused("diff good.toml good.toml", "good.toml");
  refused("run good.toml --trace", "add --report FILE");
  refused("diff a b --tolerance exakt", "did you mean \"exact\"?");
  refused("golden", "subcommand");
  refused("golden check none", "there is no golden in this folder");
  refused("golden make g good.toml --stills 0.1", "--reason");
  refused("golden make g good.toml --reason x", "--stills");
  refused("golden make g good.toml --reason x --stills 7", "7 s is not in the film");
  refused("golden make g goood.toml --reason x --stills 0.1", "goood.toml");
  refused("run good.toml --stills 0.1", "--frames");
  refused("run good.toml --stills 0.1 --frames f -o v.mp4", "--stills");
  refused("bench bots", "did you mean \"bowls\"?");
  refused("bench boats_10 --threads 1000", "--threads: \"1000\" is no count: from 0 to 256");
  refused("run", "ornament");
  refused("run ornamnt", "did you mean \"ornament\"?");
  refused("run god.toml", "did you mean \"good.toml\"?");
  refused("check good", "did you mean \"good.toml\"?");
  folder.write("cup.OBJ", "");
  refused("run cup.OBJ", "this is a mesh; a scene says what becomes of it");
  refused("run bad.toml", "bad.toml:2:1");
  refused("check bad.toml", "did you mean \"seconds\"?");
  refused("check", "shatterbox check --help tells what it takes");
  refused("run good.toml --sise 3x4", "--sise");
  refused("run good.toml --size 640", "WIDTHxHEIGHT");
  refused("run good.toml --size 641x360", "even numbers");
  refused("run good.toml --quality ful", "--quality: there is no \"ful\"\n    did you mean \"full\"?");
  refused("run good.toml --seconds abc",
          "--seconds: \"abc\" is no number\n    --seconds: how long to simulate, s");
  refused("run good.toml --seed 1.5", "--seed: \"1.5\" is no whole number");
  refused("run good.toml --frames f --stills .1,b", "--stills: \".1,b\" is no number");
  refused("run good.toml --report", "--report takes a value");
  refused("run good.toml --fps 0", "--fps");
  refused("run good.toml --fps 23.976", "24 for 23.976");
  refused("run good.toml --seconds -1", "from 0.001");
  refused("run good.toml --seconds nan", "");
  refused("run good.toml --set crate.sice=1", "did you mean \"size\"?");
  refused("run good.toml --script none.toml", "none.toml");
  refused("run good.toml -o video.xyz", "video.xyz");
  refused("run good.toml -o no/such/folder/v.mp4", "there is no folder");
  refused("run good.toml --no-render --report no/such/r.json", "there is no folder");
  refused("run good.toml --no-render -o v.mp4", "--no-render");
  refused("run good.toml --no-render --meshes good.toml", "good.toml");
  refused("run good.toml --no-render --tables good.toml", "good.toml");
  refused("run good.toml --no-render --truth t", "--no-render");
  refused("run good.toml --export film.gltf", ".glb");
  refused("run good.toml --export no/such/film.glb", "there is no folder");
  refused("run reel --export film.glb", "shots");
}

TEST_CASE("what is wrong with a mesh file is told with its line, and the scene's line that asked for it") {
  const Folder folder;
  folder.write("bad mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  folder.write("my scene.toml", "\xEF\xBB\xBF[[body]]\nkind = \"shell\"\nmesh = \"bad mesh.obj\"\n");
  const Outcome outcome = program(folder, "check 'my scene.toml'");
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("my scene.toml:3:8: bad mesh.obj:4: this face names vertex 9") == 0);
}

TEST_CASE("a reader that goes away, and a full device, are told with their status") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string run = SHATTERBOX_PROGRAM " run good.toml --no-render --seconds 0.1 ";
  const Outcome piped = shell(folder, run + "--report r.json | true; [ -s r.json ]");
  CHECK(piped.status == 0);  // the report is there, whoever listens
  const Outcome full = shell(folder, run + "> /dev/full");
  CHECK(full.status == 3);
  CHECK(full.err.find("No space left") != std::string::npos);
  // What is no plain file would be replaced by one.
  const Outcome pipe = shell(folder, "mkfifo p; " + run + "--report p");
  CHECK(pipe.status == 2);
  CHECK(pipe.err.find("p cannot be written: is no plain file") != std::string::npos);
  CHECK(fs::is_fifo(folder / "p"));
}

TEST_CASE("what the README tells a newcomer to save and run can be run") {
  const Folder folder;
  // The indented block after the first mention of a file.
  const auto save = [&](const std::string& name) {
    const std::string readme = read_text(SHATTERBOX_SOURCE_DIR "/README.md");
    const std::size_t mention = readme.find("`" + name + "`");
    REQUIRE(mention != std::string::npos);
    std::istringstream lines(readme.substr(readme.find("\n\n    ", mention) + 2));
    std::string line, block;
    while (std::getline(lines, line) && line.starts_with("    ")) block += line.substr(4) + "\n";
    folder.write(name, block);
  };
  save("ball.toml");
  save("throws.toml");
  const Outcome check = program(folder, "check ball.toml --script throws.toml");
  CAPTURE(check.out, check.err);
  CHECK(check.status == 0);
  CHECK(check.err.empty());
  const Outcome run = program(folder, "run ball.toml --script throws.toml --seconds 1.6 --no-render");
  CAPTURE(run.out, run.err);
  CHECK(run.status == 0);
  CHECK(run.out.find(" pieces, ") != std::string::npos);
}

TEST_CASE("check and list say what there is") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const Outcome checked = program(folder, "check good.toml");
  INFO(checked.err);
  CHECK(checked.status == 0);
  CHECK(checked.out.find("good.toml: fine. 10 bodies") != std::string::npos);
  const Outcome listed = program(folder, "list");
  CHECK(listed.status == 0);
  for (const char* word :
       {"ornament", "window", "bowl", "glass", "projectile", "studio, noon, evening, overcast"}) {
    CHECK(listed.out.find(word) != std::string::npos);
  }
}

TEST_CASE("bash completes verbs, options, scenes and words of options") {
  const Folder folder;
  folder.write("complete.sh",
               "source '" SHATTERBOX_SOURCE_DIR
               "/sandbox/completion.bash'\n"
               "COMP_WORDS=(\"$@\")\nCOMP_CWORD=$(($# - 1))\n_shatterbox\necho \"${COMPREPLY[*]}\"\n");
  folder.write("orange.toml", kSmallScene);
  const auto completed = [&folder](const std::string& words) {
    return shell(folder, "bash complete.sh " SHATTERBOX_PROGRAM " " + words).out;
  };
  CHECK(completed("pl") == "plan\n");
  CHECK(completed("run orn") == "ornament ornaments\n");
  CHECK(completed("run ora") == "orange.toml\n");
  CHECK(completed("run ornament --qu") == "--quality\n");
  CHECK(completed("run ornament --quality ''") == "preview full\n");
  CHECK(completed("golden ''") == "make check\n");
  CHECK(completed("golden make --reas") == "--reason\n");
  CHECK(completed("study mot") == "motion\n");
}

TEST_CASE("an installed program finds the scenes that were installed with it") {
  const Folder folder;
  fs::create_directories(folder / "bin");
  fs::create_directories(folder / "share/shatterbox/scenes");
  fs::copy_file(SHATTERBOX_PROGRAM, folder / "bin/shatterbox");
  folder.write("share/shatterbox/scenes/lonely.toml", kSmallScene);
  CHECK(shell(folder, "bin/shatterbox list").out.find("lonely") != std::string::npos);
  CHECK(shell(folder, "bin/shatterbox check lonely").status == 0);
}

TEST_CASE("the option --no-render simulates and reports, with no picture and no bar") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const Outcome outcome = program(folder, "run good.toml --no-render --report r.json --meshes m --fps 10");
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(outcome.err.empty());  // not a terminal
  const auto json = read_json(folder / "r.json");
  CHECK(json["steps"] == 120);
  CHECK(json["frame_hashes"].empty());
  CHECK(json["bodies"]["end"] == 10);
  CHECK(fs::exists(folder / "m/frame_000004.obj"));
  CHECK_FALSE(fs::exists(folder / "good.mp4"));
  CHECK(outcome.out.find("than real time") != std::string::npos);
}

TEST_CASE("a model and tables are outputs of their own, whole under their names") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const Outcome outcome = program(folder, "run good.toml --export film.glb --tables t");
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(outcome.out.find("wrote film.glb") != std::string::npos);
  CHECK(read_text(folder / "film.glb").substr(0, 4) == "glTF");
  CHECK(fs::exists(folder / "t/trajectories.csv"));
  CHECK_FALSE(fs::exists(folder / "film.glb.part"));
  CHECK_FALSE(fs::exists(folder / "good.mp4"));
}

TEST_CASE("truth beside the film: a file a picture, which numpy reads, and who is who") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string run = "run good.toml --size 64x48 --fps 20 --seconds 0.3 ";
  const Outcome outcome = program(folder, run + "--frames f --truth t --report r.json");
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  REQUIRE(program(folder, run + "--frames g --report plain.json").status == 0);
  CHECK(read_json(folder / "r.json")["frame_hashes"] == read_json(folder / "plain.json")["frame_hashes"]);
  CHECK(fs::exists(folder / "t/truth_000005.npz"));
  CHECK_FALSE(fs::exists(folder / "t/truth_000006.npz"));
  CHECK(read_json(folder / "t/bodies.json")["rows"].size() == 10);
  CHECK(shell(folder, "python3 -m zipfile -t t/truth_000003.npz").status == 0);
  REQUIRE(program(folder, run + "--stills 0.15 --truth s").status == 0);
  CHECK(read_text(folder / "s/truth_000003.npz") == read_text(folder / "t/truth_000003.npz"));
}

TEST_CASE(
    "bench runs what is named, tells times in a table and in JSON, one row for each number of threads") {
  const Folder folder;
  const Outcome outcome = program(folder, "bench boats_10 card --brief --threads 1,2 --report b.json");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(outcome.out.find("boats_10 ") != std::string::npos);
  CHECK(outcome.out.find("boats_100 ") == std::string::npos);  // boats_10 is a name in full
  const auto rows = read_json(folder / "b.json");
  REQUIRE(rows.size() == 4);
  CHECK(rows[0]["name"] == "boats_10");
  CHECK(rows[3]["name"] == "card_house");
  CHECK(rows[2]["threads"] == 1);
  CHECK(rows[3]["threads"] == 2);
  CHECK(rows[2]["state_hash"] == rows[3]["state_hash"]);
  for (const auto& row : rows) {
    CHECK(row["frame"]["median"].get<double>() > 0.0);
    CHECK(row["memory_mb"].get<double>() > 1.0);
    CHECK(row["crossings"].is_null());  // not asked for
    for (const char* phase : {"busy", "after", "impact", "rest"}) CHECK(row["phases"].contains(phase));
  }
  CHECK(program(folder, "bench boats_10 --brief --report no/such/b.json").status == 3);
}

TEST_CASE("stills are the pictures that the whole film has at these moments") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string picture = " --size 64x48 --fps 20 --seconds 0.3 --frames ";
  REQUIRE(program(folder, "run good.toml" + picture + "all").status == 0);
  const Outcome stills =
      program(folder, "run good.toml" + picture + "some --stills 0.1,0.26 --report r.json");
  INFO(stills.err);
  REQUIRE(stills.status == 0);
  CHECK(read_text(folder / "some/frame_000002.png") == read_text(folder / "all/frame_000002.png"));
  CHECK(read_text(folder / "some/frame_000005.png") == read_text(folder / "all/frame_000005.png"));
  CHECK_FALSE(fs::exists(folder / "some/frame_000003.png"));
  const auto json = read_json(folder / "r.json");
  CHECK(json["frame_hashes"].size() == 2);
  CHECK(json["steps"] == 72);  // the world goes on to its end
}

TEST_CASE("diff: 0 for the same, 1 and the place for a difference, of pictures, folders and videos") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string run = "run good.toml --size 64x48 --fps 20 --seconds 0.3 ";
  REQUIRE(program(folder, run + "--frames a -o a.mp4").status == 0);
  REQUIRE(program(folder, run + "--frames b -o b.mkv --set crate.colour='\"#ff0000\"'").status == 0);
  CHECK(program(folder, "diff a a --tolerance exact").status == 0);
  CHECK(program(folder, "diff a.mp4 a.mp4 --tolerance exact").status == 0);
  CHECK(program(folder, "diff a/frame_000000.png a/frame_000000.png").status == 0);
  CHECK(program(folder, "diff a.mp4 b.mkv").status == 1);
  // A film and its own frames: the encoder's loss is what the tolerance for videos is for.
  CHECK(program(folder, "diff a a.mp4").status == 1);
  CHECK(program(folder, "diff a a.mp4 --tolerance video").status == 0);
  const Outcome found =
      program(folder, "diff a b --report r.json --junit j.xml --picture d.png --pictures ds");
  INFO(found.out << found.err);
  CHECK(found.status == 1);
  CHECK(found.out.find("first  frame_000000.png") != std::string::npos);
  CHECK(read_json(folder / "r.json")["frames_compared"] == 6);
  CHECK(read_text(folder / "j.xml").find("failures=\"6\"") != std::string::npos);
  CHECK(fs::exists(folder / "d.png"));
  CHECK(fs::exists(folder / "ds/frame_000005.png"));
  CHECK(program(folder, "diff a b --report no/such/r.json").status == 2);
  CHECK(program(folder, "diff a a --picture no/such/p.png").status == 2);
  const Outcome mixed = program(folder, "diff a r.json");
  CHECK(mixed.status == 2);
  CHECK(mixed.err.find("a is a folder and r.json a report") != std::string::npos);
  shell(folder, "head -c 1500 a.mp4 > cut.mp4");
  const Outcome cut = program(folder, "diff cut.mp4 a.mp4");
  CHECK(cut.status == 2);
  CHECK(cut.err.find("cut.mp4") == 0);  // and nothing of what the decoder mutters
}

TEST_CASE("two runs that part are told by step and stage and body and traced ones are the same runs") {
  const Folder folder;
  folder.write("s.toml", kSmallScene);
  const auto run = [&folder](const std::string& arguments) {
    REQUIRE(program(folder, "run s.toml --no-render " + arguments).status == 0);
  };
  run("--report plain.json");
  run("--report a.json --trace --threads 1");
  run("--report b.json --trace --threads 3");
  run("--report c.json --trace --set crate.velocity='[0, 0, 1e-13]'");
  CHECK(program(folder, "diff plain.json a.json").status == 0);
  CHECK(program(folder, "diff a.json b.json").status == 0);
  const Outcome outcome = program(folder, "diff a.json c.json");
  CHECK(outcome.status == 1);
  CHECK(
      outcome.out.find("first    step 1, stage acts (part 1 of 1, pass 1), body 10 \"crate\", velocity: ") !=
      std::string::npos);
}

TEST_CASE("diff: two reports of one scene are the same and those of two seeds are not") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string run = "run good.toml --no-render --seconds 0.2 --report ";
  REQUIRE(program(folder, run + "a.json").status == 0);
  REQUIRE(program(folder, run + "b.json --threads 1").status == 0);
  REQUIRE(program(folder, run + "c.json --seed 2").status == 0);
  CHECK(program(folder, "diff a.json b.json").status == 0);
  const Outcome found = program(folder, "diff a.json c.json --report r.json --junit j.xml");
  CHECK(found.status == 1);
  CHECK(found.out.find("seed: 1 and 2 (50 %)") != std::string::npos);
  CHECK(read_json(folder / "r.json")["values_differing"] > 1);
  CHECK(read_text(folder / "j.xml").find("name=\"state_hash\"") != std::string::npos);
  CHECK(program(folder, "diff a.json good.toml").status == 2);
  CHECK(program(folder, "diff a.json r.json").err.find("no report_version") != std::string::npos);
  CHECK(program(folder, "diff a.json b.json --picture p.png").status == 2);
  CHECK(program(folder, "diff a.json b.json --tolerance video").status == 2);
}

TEST_CASE("golden: made, checked, a change found and told, made again with a reason that is kept") {
  const Folder folder;
  fs::create_directories(folder / "scenes");
  folder.write("scenes/good.toml", kSmallScene);
  const Outcome made = program(
      folder, "golden make g scenes/good.toml --size 64x48 --seconds 0.3 --stills 0.1,0.25 --reason first");
  INFO(made.out << made.err);
  REQUIRE(made.status == 0);
  CHECK(fs::exists(folder / "g/good/frame_000006.png"));
  // The scene is found from wherever one stands.
  const Outcome good = shell(folder, "cd scenes && " SHATTERBOX_PROGRAM " golden check ../g");
  INFO(good.out << good.err);
  CHECK(good.status == 0);
  CHECK(good.out.find("good: state equal; 2 pictures: the same, to the bit") == 0);

  std::string changed = kSmallScene;
  changed.replace(changed.find("radius = 0.05"), 13, "radius = 0.04");
  folder.write("scenes/good.toml", changed);
  const Outcome bad = program(folder, "golden check g good --report r.json --junit j.xml --pictures d");
  CHECK(bad.status == 1);
  CHECK(bad.out.find("state differs; 2 of 2 pictures differ") != std::string::npos);
  CHECK(bad.out.find("golden make g --reason") != std::string::npos);
  CHECK(read_json(folder / "r.json")[0]["same"] == false);
  CHECK(read_text(folder / "j.xml").find("failures=\"1\"") != std::string::npos);
  CHECK(fs::exists(folder / "d/good/frame_000006.png"));

  REQUIRE(program(folder, "golden make g --reason 'smaller balls'").status == 0);
  CHECK(program(folder, "golden check g").status == 0);
  const auto golden = read_json(folder / "g/good/golden.json");
  REQUIRE(golden["reasons"].size() == 2);
  CHECK(golden["reasons"][0]["reason"] == "first");
  CHECK(golden["reasons"][1]["reason"] == "smaller balls");
  CHECK(golden["reasons"][1]["state_hash"] == golden["state_hash"]);
  CHECK_FALSE(fs::exists(folder / "g/good.part"));
  CHECK(program(folder, "golden check g god").status == 2);
  CHECK(program(folder, "golden check g --junit no/such/j.xml").status == 2);
  fs::create_directories(folder / "damaged/x");
  for (const char* text :
       {"", "[]", "{\"golden_version\": \"1\"}",
        "{\"golden_version\":1,\"scene\":\"s\",\"arguments\":[1],\"state_hash\":\"\",\"reasons\":[]}"}) {
    folder.write("damaged/x/golden.json", text);
    const Outcome damaged = program(folder, "golden check damaged");
    CHECK(damaged.status == 2);
    CHECK(damaged.err.find("damaged/x/golden.json: is no golden") != std::string::npos);
  }

  // A scene that fails leaves the golden as it was.
  folder.write("scenes/good.toml", "[scene\n");
  CHECK(program(folder, "golden make g --reason broken").status == 2);
  CHECK(read_json(folder / "g/good/golden.json")["reasons"].size() == 2);
}

TEST_CASE("the option --audit checks every step and leaves the result as it is") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  REQUIRE(program(folder, "run good.toml --no-render --report plain.json").status == 0);
  const Outcome outcome = program(folder, "run good.toml --no-render --audit --report r.json");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 0);
  const auto plain = read_json(folder / "plain.json"), json = read_json(folder / "r.json");
  CHECK(plain["audit"]["on"] == false);
  CHECK(json["audit"]["on"] == true);
  CHECK(json["audit"]["steps"] == json["steps"]);
  CHECK(json["audit"]["crossings"] == 0);
  CHECK(json["audit"]["passages"] == 0);
  CHECK(json["audit"]["first_time"].is_null());
  CHECK(json["state_hash"] == plain["state_hash"]);
}

TEST_CASE("the same scene gives the same bits with one thread and two") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  std::string hashes[3];
  const char* const arguments[] = {"--threads 1", "--threads 2", "--threads 2 --seed 5"};
  for (int i = 0; i < 3; ++i) {
    REQUIRE(
        program(folder, std::string("run good.toml --no-render --report r.json ") + arguments[i]).status ==
        0);
    hashes[i] = read_json(folder / "r.json")["state_hash"];
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] != hashes[2]);  // the seed moves the jitter
}

TEST_CASE("a video and pictures of the size asked for, two runs are equal to the bit") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string run = "run good.toml --seconds 0.2 --fps 30 --size 64x48 -o v.mp4 --frames f --report ";
  REQUIRE(program(folder, run + "a.json").status == 0);
  REQUIRE(program(folder, run + "b.json").status == 0);
  CHECK(count_frames(folder, "v.mp4") == 6);
  CHECK(fs::exists(folder / "f/frame_000005.png"));
  CHECK_FALSE(fs::exists(folder / "f/frame_000006.png"));
  const auto a = read_json(folder / "a.json"), b = read_json(folder / "b.json");
  CHECK(a["frame_hashes"].size() == 6);
  CHECK(a["frame_hashes"] == b["frame_hashes"]);
  CHECK(a["state_hash"] == b["state_hash"]);
}

TEST_CASE("Ctrl-C leaves a playable video, even where the shell ignores the signal") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  for (const char* ignored : {"", "trap '' INT; "}) {
    const Outcome outcome = shell(
        folder, std::string(ignored) + SHATTERBOX_PROGRAM +
                    " run good.toml --seconds 600 --size 64x48 -o v.mp4 --report r.json & "
                    "p=$!; for i in $(seq 300); do sleep 0.1; [ -s v.mp4.part ] && break; done; sleep 1; "
                    "kill -INT $p; wait $p");
    INFO(outcome.out << outcome.err);
    CHECK(outcome.status == 3);
    CHECK(outcome.out.find("interrupted") != std::string::npos);
    const int frames = count_frames(folder, "v.mp4");
    CHECK(frames > 0);
    const auto json = read_json(folder / "r.json");
    CHECK(json["interrupted"] == true);
    CHECK(json["frame_hashes"].size() == static_cast<std::size_t>(frames));
    fs::remove(folder / "v.mp4");
  }
}

TEST_CASE("a disk that is full ends the run with status 3 and the reason") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const Outcome outcome = shell(folder, std::string("trap '' XFSZ; ulimit -f 8; ") + SHATTERBOX_PROGRAM +
                                            " run good.toml --seconds 20 --size 320x240 -o v.mp4");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.status == 3);
  CHECK(outcome.err.find("failed:") != std::string::npos);
  for (const std::string output : {"--frames", "--truth", "--meshes"}) {
    const Outcome other = shell(folder, std::string("trap '' XFSZ; ulimit -f 8; ") + SHATTERBOX_PROGRAM +
                                            " run good.toml --size 640x480 " + output + " d");
    INFO(other.err);
    CHECK(other.status == 3);
    CHECK(other.err.find("_000000.") != std::string::npos);
    CHECK(other.err.find("cannot be written: File too large") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "d/frame_000000.obj"));
  }
}
