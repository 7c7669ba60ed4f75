//! The folders of the user: the store, and the models.

use super::{Row, Verdict, size};
use crate::{places::Folder, scene::Models, store::Store};

pub fn rows() -> Vec<Row> {
    let store = Store::open();
    let kept = store.kinds().into_iter().map(|kind| {
        let entries = store.list(&kind);
        let bytes = entries.iter().map(|entry| entry.bytes).sum();
        Row::ok(format!("store: {kind}"), format!("{} entries, {}", entries.len(), size(bytes)))
    });
    [place(&store)].into_iter().chain(kept).chain([models(&Models::open())]).collect()
}

fn place(store: &Store) -> Row {
    let variable = Folder::Cache.variable();
    let Some(folder) = store.folder() else {
        let remedy = format!("name a folder in {variable}; until then, shaders are compiled in every run");
        return Row::new("store", "no folder can be written to", Verdict::Warn, &remedy);
    };
    match Folder::Cache.candidates().first().filter(|first| *first != folder) {
        Some(first) => {
            let found = format!("{}, as {} cannot be written to", folder.display(), first.display());
            Row::new("store", found, Verdict::Warn, &format!("name a folder of yours in {variable}"))
        }
        None => Row::ok("store", format!("{}, writable", folder.display())),
    }
}

/// Models are wanted by those scenes alone that name them.
fn models(models: &Models) -> Row {
    let Some(folder) = models.folder() else {
        return Row::new("models", "no folder", Verdict::Ok, &format!("name one in {}", Folder::Models.variable()));
    };
    let names = models.names();
    if names.is_empty() {
        let remedy = "scripts/fetch-models fills it, for scenes that name model:NAME";
        return Row::new("models", format!("{}: none", folder.display()), Verdict::Ok, remedy);
    }
    Row::ok("models", format!("{}: {}", folder.display(), names.join(", ")))
}
