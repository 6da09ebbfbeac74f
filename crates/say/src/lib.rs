//! `say!("the unit {unit} of {name} is unknown")`: a text that is kept as a template with its values, so that it can
//! be drawn in another language than the one it is written in. Use it through `gumption_fault::say`.

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::{Error, Ident, LitStr, Result, Token};

/// Written like `format!`, without `$` and `*`; gives a `gumption_fault::Said`, constant where nothing is inserted.
/// A value that is itself a `Said` is drawn in the language of the whole.
#[proc_macro]
pub fn say(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let said = syn::parse::<Call>(input).and_then(|call| call.said());
    said.unwrap_or_else(Error::into_compile_error).into()
}

struct Call {
    template: LitStr,
    arguments: Vec<(Option<Ident>, TokenStream)>,
}

impl Parse for Call {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let template = input.parse()?;
        let mut arguments = Vec::new();
        while !input.is_empty() {
            input.parse::<Token![,]>()?;
            if input.is_empty() {
                break;
            }
            let named = input.peek(Ident) && input.peek2(Token![=]);
            let name = named.then(|| input.parse()).transpose()?;
            if named {
                input.parse::<Token![=]>()?;
            }
            let mut value = TokenStream::new();
            while !input.is_empty() && !input.peek(Token![,]) {
                value.extend([input.parse::<TokenTree>()?]);
            }
            arguments.push((name, value));
        }
        Ok(Call {
            template,
            arguments,
        })
    }
}

/// `{name:spec}`.
struct Place {
    name: String,
    spec: String,
}

impl Call {
    fn said(&self) -> Result<TokenStream> {
        let template = &self.template;
        let places = self.places()?;
        for (index, (name, value)) in self.arguments.iter().enumerate() {
            let name = name.as_ref().map_or(index.to_string(), Ident::to_string);
            if !places.iter().any(|place| place.name == name) {
                return Err(Error::new_spanned(value, "no place of the template has it"));
            }
        }
        if places.is_empty() {
            return Ok(quote!(::gumption_fault::Said::plain(#template)));
        }
        let values = places.iter().map(|place| self.value(place));
        let values = values.collect::<Result<Vec<_>>>()?;
        Ok(quote!(::gumption_fault::Said::new(#template, ::std::vec![#(#values),*])))
    }

    /// The places of the template, each once.
    fn places(&self) -> Result<Vec<Place>> {
        let text = self.template.value().replace("{{", "").replace("}}", "");
        let mut places: Vec<Place> = Vec::new();
        let mut next = 0;
        for part in text.split('{').skip(1) {
            let Some((inside, _)) = part.split_once('}') else {
                return Err(Error::new(self.template.span(), "a brace is not closed"));
            };
            let (name, spec) = inside.split_once(':').unwrap_or((inside, ""));
            if spec.contains(['$', '*']) {
                return Err(Error::new(
                    self.template.span(),
                    "`$` and `*` are not known",
                ));
            }
            let mut name = name.to_owned();
            if name.is_empty() {
                name = next.to_string();
                next += 1;
            }
            if !places.iter().any(|p| p.name == name && p.spec == spec) {
                let spec = spec.to_owned();
                places.push(Place { name, spec });
            }
        }
        Ok(places)
    }

    /// The pair of key and value.
    fn value(&self, place: &Place) -> Result<TokenStream> {
        let expression = self.expression(&place.name)?;
        if place.spec.is_empty() {
            let key = &place.name;
            return Ok(quote!((#key, {
                use ::gumption_fault::said::AsText as _;
                ::gumption_fault::said::Inserted(&(#expression)).value()
            })));
        }
        let key = format!("{}:{}", place.name, place.spec);
        let format = format!("{{:{}}}", place.spec);
        Ok(
            quote!((#key, ::gumption_fault::said::Value::Text(::std::format!(#format, #expression)))),
        )
    }

    fn expression(&self, name: &str) -> Result<TokenStream> {
        let span = self.template.span();
        if let Ok(index) = name.parse::<usize>() {
            let given = self.arguments.get(index);
            return match given {
                Some((None, value)) => Ok(value.clone()),
                _ => Err(Error::new(span, format!("there is no argument {index}"))),
            };
        }
        let named = |(own, value): &(Option<Ident>, TokenStream)| {
            own.as_ref()
                .is_some_and(|own| own == name)
                .then(|| value.clone())
        };
        match self.arguments.iter().find_map(named) {
            Some(value) => Ok(value),
            None => {
                let name = syn::parse_str::<Ident>(name).map_err(|e| Error::new(span, e))?;
                let name = Ident::new(&name.to_string(), call_site(span));
                Ok(quote!(#name))
            }
        }
    }
}

/// Names of the caller are seen where the caller stands.
fn call_site(span: Span) -> Span {
    span.resolved_at(Span::call_site())
}
