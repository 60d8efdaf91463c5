//! Access to the side files of a model.

/// A source of a model's side files.
pub trait Resources {
    /// Finds the file that a model calls `name`, and returns one name per file for all its
    /// spellings.
    ///
    /// # Errors
    /// The reason why the file cannot or must not be opened.
    fn resolve(&self, name: &str) -> Result<String, ResourceError>;

    /// Finds a texture by the last part of the path `name`, in places where textures usually are.
    /// It is asked for names that [`Self::resolve`] does not find; without an implementation it
    /// finds nothing.
    ///
    /// # Errors
    /// `NotFoundIn` with the places, or `NotFound` if there are none.
    fn search(&self, name: &str) -> Result<String, ResourceError> {
        let _ = name;
        Err(ResourceError::NotFound)
    }

    /// The bytes of a file that [`Self::resolve`] or [`Self::search`] found, if there are at most
    /// `max_bytes`.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError>;
}

/// The reason why a side file is not opened.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ResourceError {
    /// The input has no folder (it came from a pipe).
    #[error("side files are not available for this input")]
    Unavailable,
    /// No file of that name.
    #[error("no such file in the model's folder")]
    NotFound,
    /// No file whose own name is that of the path, in any of these places.
    #[error("there is no file `{name}` in {places}; copy it there, or add its folder as a root")]
    NotFoundIn {
        /// The last part of the path.
        name: String,
        /// The places, for messages.
        places: String,
    },
    /// The name leads out of the model's folder.
    #[error("it is outside the model's folder; side files are read from that folder only")]
    Outside,
    /// A folder, a device, a pipe.
    #[error("it is not a regular file")]
    NotRegular,
    /// Larger than allowed.
    #[error("it is larger than the limit of {0} bytes")]
    TooLarge(u64),
    /// The system's message.
    #[error("{0}")]
    Io(String),
}

/// No side files, for models from a pipe.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoResources;

impl Resources for NoResources {
    fn resolve(&self, _name: &str) -> Result<String, ResourceError> {
        Err(ResourceError::Unavailable)
    }

    fn read(&self, _resolved: &str, _max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        Err(ResourceError::Unavailable)
    }
}
