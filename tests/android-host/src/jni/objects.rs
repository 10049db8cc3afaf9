//! Java objects and references to them.

use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex};

use jni_sys::jobject;

use crate::host::{fatal, lock};

/// A Java object.
#[derive(Debug)]
pub struct Object {
    /// The class's name with slashes, such as `android/content/Intent`.
    pub class: String,
    /// The object's data.
    pub data: Data,
}

/// The data of an object.
#[derive(Debug)]
pub enum Data {
    /// No data.
    None,
    /// The text of a string, or the path of a file.
    Text(String),
    /// The name of a class, with slashes.
    Class(String),
    /// The extras of an intent or a bundle, by key.
    Extras(BTreeMap<String, Value>),
    /// An array or a collection of objects.
    Array(Mutex<Vec<Option<Arc<Object>>>>),
    /// A table returned by a content provider.
    Cursor(Cursor),
    /// An open file, until its descriptor is taken.
    File(Mutex<Option<std::fs::File>>),
}

/// A table of texts, and the current row.
#[derive(Debug)]
pub struct Cursor {
    /// The columns' names.
    pub columns: Vec<String>,
    /// The rows' texts, in the columns' order.
    pub rows: Vec<Vec<String>>,
    /// The number of rows moved to so far, which is the index of the next row.
    pub moves: AtomicUsize,
}

impl Object {
    /// Creates an object of a class.
    pub fn new(class: &str, data: Data) -> Arc<Self> {
        Arc::new(Self { class: class.to_owned(), data })
    }

    /// Creates a string.
    pub fn string(text: &str) -> Arc<Self> {
        Self::new("java/lang/String", Data::Text(text.to_owned()))
    }

    /// Creates a class object.
    pub fn class_of(name: &str) -> Arc<Self> {
        Self::new("java/lang/Class", Data::Class(name.to_owned()))
    }

    /// Returns the text of a string.
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
    /// `float`.
    Float(f32),
    /// An object or null.
    Object(Option<Arc<Object>>),
}

impl Value {
    /// Returns a non-null object as a value.
    pub fn object(object: Arc<Object>) -> Self {
        Self::Object(Some(object))
    }
}

/// A method or a field.
#[derive(Debug, PartialEq, Eq, Hash, Clone)]
pub struct Member {
    /// The class in which it was looked up, with slashes.
    pub class: String,
    /// Name.
    pub name: String,
    /// JNI signature.
    pub signature: String,
}

impl Member {
    /// Returns the type at the end of the signature, in JNI's notation.
    pub fn returned(&self) -> &str {
        self.signature.rsplit(')').next().unwrap_or("V")
    }

    /// Returns the class of the object that a method returns, with slashes, or `None` if it returns something else.
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

/// The state of the virtual machine.
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
    /// Creates a machine without objects.
    pub fn new() -> Self {
        Self { references: Mutex::default(), members: Mutex::default(), invented: Mutex::default() }
    }

    /// Returns the number of references of all kinds and threads.
    pub fn live_references(&self) -> u64 {
        lock(&self.references).live.len() as u64
    }

    /// Returns the unknown calls, with the number of times each was made.
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
        // Multiples of 8 like pointers, and never reused.
        references.last += 8;
        let handle = references.last;
        references.live.insert(handle, Reference { object, kind });
        handle as jobject
    }

    /// Returns a new reference to the same object, or null for null.
    pub(super) fn again(&self, handle: jobject, kind: Kind) -> jobject {
        self.get(handle).map_or(std::ptr::null_mut(), |object| self.add(object, kind))
    }

    /// Deletes a reference, which must be of this kind. Null is ignored.
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

    /// Returns the object that a reference refers to, or `None` for null.
    pub(super) fn get(&self, handle: jobject) -> Option<Arc<Object>> {
        if handle.is_null() {
            return None;
        }
        match lock(&self.references).live.get(&(handle as usize)) {
            Some(reference) => Some(reference.object.clone()),
            None => fatal("JNI: a reference was used that does not exist any more"),
        }
    }

    /// Returns the unique identifier of a member.
    pub(super) fn member(&self, member: Member) -> &'static Member {
        lock(&self.members).entry(member).or_insert_with_key(|member| Box::leak(Box::new(member.clone())))
    }
}
