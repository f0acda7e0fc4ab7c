//! Completions and man pages of the program.

mod program_scene;

use program_scene::Scene;

#[test]
fn shells_and_man_know_every_command() {
    let scene = Scene::empty();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = scene.accepts(&["completions", shell]).stdout;
        assert!(text.contains("trax") && text.contains("annotate"), "{shell}");
    }
    scene.accepts(&["completions", "--out", "c", "--man", "deep/man"]);
    assert_eq!(std::fs::read_dir(scene.path("c")).unwrap().count(), 5);
    let page = scene.read("deep/man/infopart-track.1");
    assert!(page.starts_with(".ie") && page.contains("annotate"), "{page}");
    scene.refuses(&["completions"], &["--man"]);
    scene.refuses(&["completions", "tcsh"], &["bash"]);
    scene.write("taken", b"");
    scene.refuses(&["completions", "--out", "taken/c"], &["taken/c", "another folder"]);
}
