//! Objects and references.

use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex};

use jni_sys::jobject;

use crate::host::{fatal, lock};

/// A Java object.
#[derive(Debug)]
pub struct Object {
    /// The class's name with slashes: `android/content/Intent`.
    pub class: String,
    /// Its data.
    pub data: Data,
}

/// The data of an object.
#[derive(Debug)]
pub enum Data {
    /// No data, only a class.
    None,
    /// A string's text, or a file's path.
    Text(String),
    /// A class's name, with slashes.
    Class(String),
    /// An intent, or a bundle: extras by key.
    Extras(BTreeMap<String, Value>),
    /// An array or a collection of objects.
    Array(Mutex<Vec<Option<Arc<Object>>>>),
    /// A table that a content provider gave.
    Cursor(Cursor),
    /// An open file, until somebody takes it.
    File(Mutex<Option<std::fs::File>>),
}

/// Rows of texts, and the number of rows moved to.
#[derive(Debug)]
pub struct Cursor {
    /// The columns' names.
    pub columns: Vec<String>,
    /// The rows' texts, in the columns' order.
    pub rows: Vec<Vec<String>>,
    /// The number of rows moved to so far, which is the next row's index.
    pub moves: AtomicUsize,
}

impl Object {
    /// An object of a class.
    pub fn new(class: &str, data: Data) -> Arc<Self> {
        Arc::new(Self { class: class.to_owned(), data })
    }

    /// A string.
    pub fn string(text: &str) -> Arc<Self> {
        Self::new("java/lang/String", Data::Text(text.to_owned()))
    }

    /// A class object.
    pub fn class_of(name: &str) -> Arc<Self> {
        Self::new("java/lang/Class", Data::Class(name.to_owned()))
    }

    /// The text of a string or a file.
    pub fn text(&self) -> Option<&str> {
        match &self.data {
            Data::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// A value that a method returns or a field holds.
#[derive(Clone, Debug)]
pub enum Value {
    /// `void`.
    Void,
    /// `boolean`.
    Boolean(bool),
    /// `byte`, `char`, `short` or `int`.
    Int(i32),
    /// `long`.
    Long(i64),
    /// `float`.
    Float(f32),
    /// `double`.
    Double(f64),
    /// An object or null.
    Object(Option<Arc<Object>>),
}

impl Value {
    /// A non-null object.
    pub fn object(object: Arc<Object>) -> Self {
        Self::Object(Some(object))
    }
}

/// A method or a field.
#[derive(Debug, PartialEq, Eq, Hash, Clone)]
pub struct Member {
    /// Class that it was looked up in, with slashes.
    pub class: String,
    /// Name.
    pub name: String,
    /// JNI signature.
    pub signature: String,
}

impl Member {
    /// Returns the type at the end of the signature, as JNI writes it.
    pub fn returned(&self) -> &str {
        self.signature.rsplit(')').next().unwrap_or("V")
    }

    /// Returns the class of the object that a method returns, with slashes; none if it returns something else.
    pub fn returned_class(&self) -> Option<&str> {
        self.returned().strip_prefix('L')?.strip_suffix(';')
    }
}

/// Kinds of references.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Local,
    Global,
    Weak,
}

struct Reference {
    object: Arc<Object>,
    kind: Kind,
}

/// The virtual machine's state.
pub struct Jni {
    references: Mutex<References>,
    members: Mutex<HashMap<Member, &'static Member>>,
    invented: Mutex<BTreeMap<String, u64>>,
}

#[derive(Default)]
struct References {
    live: HashMap<usize, Reference>,
    last: usize,
}

impl Jni {
    /// Makes a machine without objects.
    pub fn new() -> Self {
        Self { references: Mutex::default(), members: Mutex::default(), invented: Mutex::default() }
    }

    /// Returns the number of references of all kinds and threads.
    pub fn live_references(&self) -> u64 {
        lock(&self.references).live.len() as u64
    }

    /// Returns the calls that were answered without knowing them.
    pub fn invented(&self) -> BTreeMap<String, u64> {
        lock(&self.invented).clone()
    }

    pub(super) fn note_invented(&self, member: &Member) {
        *lock(&self.invented)
            .entry(format!("{}.{}{}", member.class, member.name, member.signature))
            .or_default() += 1;
    }

    /// Returns a new reference.
    pub(super) fn add(&self, object: Arc<Object>, kind: Kind) -> jobject {
        let mut references = lock(&self.references);
        // Multiples of 8, as pointers are, and never used twice.
        references.last += 8;
        let handle = references.last;
        references.live.insert(handle, Reference { object, kind });
        handle as jobject
    }

    /// Returns a new reference to the same object; null for null.
    pub(super) fn again(&self, handle: jobject, kind: Kind) -> jobject {
        self.get(handle).map_or(std::ptr::null_mut(), |object| self.add(object, kind))
    }

    /// Deletes a reference, which must be of this kind; null is none.
    pub(super) fn remove(&self, handle: jobject, kind: Kind) {
        if handle.is_null() {
            return;
        }
        match lock(&self.references).live.remove(&(handle as usize)) {
            Some(reference) if reference.kind == kind => {}
            Some(reference) => fatal(format!(
                "JNI: a {:?} reference to a {} was deleted as a {kind:?} one",
                reference.kind, reference.object.class
            )),
            None => fatal(format!("JNI: a {kind:?} reference was deleted that does not exist any more")),
        }
    }

    /// Returns the object behind a reference; null is none.
    pub(super) fn get(&self, handle: jobject) -> Option<Arc<Object>> {
        if handle.is_null() {
            return None;
        }
        match lock(&self.references).live.get(&(handle as usize)) {
            Some(reference) => Some(reference.object.clone()),
            None => fatal("JNI: a reference was used that does not exist any more"),
        }
    }

    /// Returns the kind of a reference; none if there is no such reference.
    pub(super) fn kind(&self, handle: jobject) -> Option<Kind> {
        lock(&self.references).live.get(&(handle as usize)).map(|reference| reference.kind)
    }

    /// Returns the one identifier of a member.
    pub(super) fn member(&self, member: Member) -> &'static Member {
        lock(&self.members).entry(member).or_insert_with_key(|member| Box::leak(Box::new(member.clone())))
    }
}
