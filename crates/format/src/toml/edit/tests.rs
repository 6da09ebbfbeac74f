use super::*;

fn path(text: &str) -> Vec<Step> {
    let step = |part: &str| part.parse().map_or(Step::Key(part.into()), Step::Index);
    text.split('.').map(step).collect()
}

fn token(text: &str) -> Content {
    Content::Token(text.into())
}

fn set(text: &str, at: &str, content: Content) -> String {
    Places::of(text).unwrap().set(&path(at), content).unwrap()
}

#[test]
fn a_value_is_replaced_where_it_stands() {
    let text = "# c\n[input] # in\nx = { value = 1.0, u=2 } # d\n";
    assert_eq!(
        set(text, "input.x.value", token("1.50")),
        "# c\n[input] # in\nx = { value = 1.50, u=2 } # d\n"
    );
}

#[test]
fn rows_change_places_with_their_comments() {
    let exchanged = |text: &str, one: &str, other: &str| {
        let places = Places::of(text).unwrap();
        let made = places.exchanged(&path(one), &path(other));
        let back = places.exchanged(&path(other), &path(one));
        assert_eq!(made, back);
        made
    };
    for (text, one, other, wanted) in [
        // Sections, with what stands above and behind them.
        (
            "# top\n\n# of a\n[input.a]\nvalue = 1 # one\n\n[input.b]\n# in b\nvalue = 2\nunit = 'V'\n",
            "input.a",
            "input.b",
            "# top\n\n[input.b]\n# in b\nvalue = 2\nunit = 'V'\n\n# of a\n[input.a]\nvalue = 1 # one\n",
        ),
        // Lines, the last without an end.
        (
            "[input]\na = { value = 1 } # one\n# of b\nb.value = 2\nb.unit = 'V'",
            "input.b",
            "input.a",
            "[input]\n# of b\nb.value = 2\nb.unit = 'V'\na = { value = 1 } # one",
        ),
        // Elements of a list: commas stay.
        (
            "components = [\r\n  { u = 1 }, # one\r\n  # of two\r\n  { u = 2 }\r\n]\r\n",
            "components.0",
            "components.1",
            "components = [\r\n  # of two\r\n  { u = 2 },\r\n  { u = 1 } # one\r\n]\r\n",
        ),
        ("x = [1, 22]\n", "x.0", "x.1", "x = [22, 1]\n"),
        (
            "[[c]]\nr = 1\n[[c]]\nr = 2\ns = 3\n",
            "c.0",
            "c.1",
            "[[c]]\nr = 2\ns = 3\n[[c]]\nr = 1\n",
        ),
    ] {
        assert_eq!(exchanged(text, one, other).as_deref(), Ok(wanted));
        assert_eq!(exchanged(wanted, one, other).as_deref(), Ok(text));
    }
    // Parts of others lie between, or they are no rows of one table.
    let torn = "[input]\na.value = 1\nb.value = 2\na.unit = 'V'\n";
    assert_eq!(exchanged(torn, "input.a", "input.b"), Err(Unedited));
    assert_eq!(exchanged(torn, "input.a.value", "input.b"), Err(Unedited));
    assert_eq!(exchanged(torn, "input.a", "input.c"), Err(Unedited));
}

#[test]
fn a_new_value_stands_as_its_neighbours() {
    let empty = || Content::Table(Vec::new());
    for (text, at, content, edited) in [
        ("", "title", token("'T'"), "title = 'T'\n"),
        ("", "input.x.u", token("1"), "[input.x]\nu = 1\n"),
        (
            "[input]\nx = {}\n",
            "title",
            token("1"),
            "title = 1\n\n[input]\nx = {}\n",
        ),
        (
            "a = 1 # one\n\n[input]\n",
            "b",
            token("2"),
            "a = 1 # one\nb = 2\n\n[input]\n",
        ),
        (
            "[input]\nx = {}\n",
            "input.x.u",
            token("1"),
            "[input]\nx = { u = 1 }\n",
        ),
        (
            "[input]\nx = {u=1}\n",
            "input.y",
            empty(),
            "[input]\nx = {u=1}\ny = {}\n",
        ),
        (
            "[input.x]\nu = 1\n\n# end\n",
            "input.y",
            empty(),
            "[input.x]\nu = 1\n\n[input.y]\n\n# end\n",
        ),
        (
            "[input.x]\nu = 1",
            "input.x.v",
            token("2"),
            "[input.x]\nu = 1\nv = 2\n",
        ),
        (
            "input.x.u = 1\ntitle = 2\n",
            "input.x.v",
            token("3"),
            "input.x.u = 1\ninput.x.v = 3\ntitle = 2\n",
        ),
        (
            "input.x.u = 1\ntitle = 2\n",
            "input.y",
            empty(),
            "input.x.u = 1\ninput.y = {}\ntitle = 2\n",
        ),
        (
            "[a.b]\nc = 1\n",
            "a.d",
            token("2"),
            "[a]\nd = 2\n\n[a.b]\nc = 1\n",
        ),
        ("x = [1, 2]\n", "x.2", token("3"), "x = [1, 2, 3]\n"),
        ("x = []\n", "x.0", token("3"), "x = [3]\n"),
        (
            "x = [\n  1, # one\n  2 # two\n]\n",
            "x.2",
            token("3"),
            "x = [\n  1, # one\n  2, # two\n  3\n]\n",
        ),
        (
            "x = [\n  1, # one\n]\n",
            "x.1",
            token("3"),
            "x = [\n  1, # one\n  3,\n]\n",
        ),
        (
            "x = 1\r\n[i]\r\n",
            "i.y",
            token("3"),
            "x = 1\r\n[i]\r\ny = 3\r\n",
        ),
        (
            "a = 1\n",
            "list.0.r",
            token("1"),
            "a = 1\n\n[[list]]\nr = 1\n",
        ),
        (
            "[[list]]\nr = 1\n[b]\n",
            "list.1",
            empty(),
            "[[list]]\nr = 1\n\n[[list]]\n[b]\n",
        ),
        (
            "[i.x]\n",
            "i.x.rows.0.u",
            token("1"),
            "[i.x]\nrows = [\n    { u = 1 },\n]\n",
        ),
    ] {
        let found = Places::of(text).unwrap().set(&path(at), content);
        assert_eq!(found.as_deref(), Ok(edited), "{text}");
    }
}

#[test]
fn what_is_removed_leaves_its_neighbours() {
    for (text, at, edited) in [
        ("a = 1 # one\nb = 2\n", "a", "b = 2\n"),
        ("x = [1, 2, 3]", "x.0", "x = [2, 3]"),
        ("x = [1, 2, 3]", "x.1", "x = [1, 3]"),
        ("x = [1, 2, 3,]", "x.2", "x = [1, 2,]"),
        ("x = { a = 1, b.c = 2 }", "x.b", "x = { a = 1 }"),
        ("x = { a = 1 }", "x.a", "x = {}"),
        ("[i.x]\nu = 1\n\n[o]\n\n[i.x.c]\nk = 2\n", "i.x", "[o]\n\n"),
        (
            "[[l]]\nr = 1\n\n# two\n[[l]]\nr = 2\n",
            "l.0",
            "# two\n[[l]]\nr = 2\n",
        ),
        ("[i.x]\nc.k = 2\nc.U = 1\n", "i.x.c", "[i.x]\n"),
        ("a = 1\n\n[x]\nb = 1\n\n[y]\n", "x", "a = 1\n\n[y]\n"),
    ] {
        let found = Places::of(text).unwrap().remove(&path(at));
        assert_eq!(found.as_deref(), Ok(edited), "{text}");
    }
}

#[test]
fn a_name_is_changed_wherever_it_is_written() {
    let text = "[i.x]\nu = 1\n[i.x.c]\nx = 2\n[o]\nx = { x = 1 }\n";
    let renamed = |at: &str, name: &str| Places::of(text).unwrap().rename(&path(at), name);
    let other = text.replace("i.x", "i.\"x y\"");
    assert_eq!(renamed("i.x", "x y"), Ok(other));
    assert_eq!(renamed("o.x.x", "z"), Ok(text.replace("{ x", "{ z")));
    assert_eq!(renamed("o.x.y", "z"), Err(Unedited));
}

#[test]
fn what_would_say_something_else_is_no_edit() {
    let places = Places::of("a = 1\n").unwrap();
    assert_eq!(places.set(&path("b"), token("1\nc = 2")), Err(Unedited));
    assert_eq!(places.set(&path("a.b"), token("1")), Err(Unedited));
    assert_eq!(places.rename(&path("b"), "c"), Err(Unedited));
    assert_eq!(Places::of("a = "), None);
}
